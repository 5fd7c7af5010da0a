// SettingsBinding.cpp - Python's class Settings, a mapping, and the table of options. Layer: apps.
// SPDX-License-Identifier: MIT
#include "SettingsBinding.h"
#include "Bindings.h"
#include "OptionNames.h"

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

py::list optionNames()
{
    py::list names;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
        names.append(option.name);
    return names;
}

py::object get(const Settings& settings, const std::string& name)
{
    const RayTraceSettings::Option option = optionOf(name);
    return optionValue(option, settings.rendering->get(option.name));
}

bool contains(const std::string& name)
{
    try
    {
        optionOf(name);
        return true;
    }
    catch (const py::value_error&)
    {
        return false;
    }
}

py::list options()
{
    py::list list;
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        py::dict row;
        row["name"] = option.name;
        row["default"] = optionValue(option, option.defaultValue);
        row["range"] = option.range;
        row["environment"] = option.environment;
        row["help"] = option.help;
        list.append(row);
    }
    return list;
}

} // namespace

void setOption(Rendering& rendering, const std::string& name, const py::handle& value)
{
    const RayTraceSettings::Option option = optionOf(name);
    const std::string asText = optionText(value);
    const std::string problem = rendering.set(option.name, asText);
    if (problem.empty()) return;
    throw py::value_error(option.name + ": '" + asText + "' cannot be: " + problem + " (" +
                          option.range + ")");
}

void bindSettings(py::module_& module)
{
    py::class_<Settings>(module, "Settings",
                         "Options of a renderer by their names, as a dictionary has them:\n"
                         "settings[\"light-samples\"] = 16. Also \"light_samples\" is the name.\n"
                         "Unknown names and values out of range raise ValueError.")
        .def("__getitem__", &get, py::arg("name"))
        .def(
            "__setitem__",
            [](const Settings& settings, const std::string& name, const py::object& value)
            { setOption(*settings.rendering, name, value); },
            py::arg("name"), py::arg("value"))
        .def(
            "__contains__", [](const Settings&, const std::string& name) { return contains(name); },
            py::arg("name"))
        .def("__len__", [](const Settings&) { return py::len(optionNames()); })
        .def("__iter__", [](const Settings&) { return py::iter(optionNames()); })
        .def(
            "keys", [](const Settings&) { return optionNames(); }, "Names of all options.")
        .def(
            "update",
            [](const Settings& settings, const py::kwargs& values)
            {
                for (const auto& [name, value] : values)
                    setOption(*settings.rendering, py::cast<std::string>(name), value);
            },
            "Sets several options: update(integrator=\"path\", max_passes=256).");
    module.def(
        "options", &options,
        "All options in the order of the documents: a list of dictionaries with name, default,\n"
        "range, environment (variable) and help.");
}

} // namespace osgRayTrace::python
