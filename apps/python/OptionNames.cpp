// OptionNames.cpp - names and values of options between Python and the option table. Layer: apps.
// SPDX-License-Identifier: MIT
#include "OptionNames.h"

#include "StatisticsDict.h"

#include <vector>

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

/// Returns the name in lower case without dashes and underscores.
std::string plainName(const std::string& name)
{
    std::string plain;
    for (const char c : name)
        if (c != '-' && c != '_')
            plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return plain;
}

/// Returns the name that difflib finds most similar; empty if none is similar.
std::string similarName(const std::string& name)
{
    py::list names;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
        names.append(option.name);
    const py::object found =
        py::module_::import("difflib").attr("get_close_matches")(text(name), names, 1);
    return py::len(found) > 0 ? py::cast<std::string>(found[py::int_(0)]) : std::string();
}

/// Returns whether a number option takes fractions: 0.5 is in the range of all that do.
bool takesFractions(const RayTraceSettings::Option& option)
{
    const osg::ref_ptr<RayTraceSettings> trial = new RayTraceSettings;
    return trial->set(option.name, "0.5");
}

} // namespace

RayTraceSettings::Option optionOf(const std::string& name)
{
    const std::string plain = plainName(name);
    const std::string wanted = plain == "passes" ? "maxpasses" : plain;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
        if (plainName(option.name) == wanted) return option;
    const std::string similar = similarName(name);
    throw py::value_error("there is no option '" + name + "'" +
                          (similar.empty() ? "" : "; do you mean '" + similar + "'?"));
}

std::string optionText(const py::handle& value)
{
    if (py::isinstance<py::bool_>(value)) return py::cast<bool>(value) ? "true" : "false";
    if (py::isinstance<py::str>(value)) return py::cast<std::string>(value);
    if (PyNumber_Check(value.ptr())) return py::str(value);
    throw py::type_error("an option is a str, a bool, an int or a float, not a " +
                         std::string(py::str(py::type::of(value).attr("__name__"))));
}

py::object optionValue(const RayTraceSettings::Option& option, const std::string& value)
{
    if (option.range == "false|true") return py::bool_(value == "true");
    const bool isNumber = option.range.find(" .. ") != std::string::npos;
    if (!isNumber) return text(value);
    const py::object number = text(value);
    if (takesFractions(option)) return py::float_(number);
    return py::int_(number);
}

} // namespace osgRayTrace::python
