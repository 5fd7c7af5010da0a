// SumsBinding.cpp - Python's class PassSums, which can be pickled. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Bindings.h"
#include "OutsidePython.h"
#include "PictureArray.h"
#include "StatisticsDict.h"

#include <osgRayTrace/PassSums>

#include <cstring>

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

template <typename T> py::bytes bytesOf(const std::vector<T>& values)
{
    return py::bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <typename T> std::vector<T> valuesOf(const py::handle& object)
{
    const std::string_view bytes = py::cast<std::string_view>(object);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

py::tuple stateOf(const PassSums& sums)
{
    return py::make_tuple(sums.width, sums.height, sums.passes, py::bytes(sums.picture),
                          bytesOf(sums.low), bytesOf(sums.high), bytesOf(sums.depth),
                          sums.displayReferred, sums.veiled);
}

/// Returns the sums of a pickled state. Damaged sums are refused by whoever uses them. Older states
/// have 8 elements, and their pictures are blended by alpha as they were then.
PassSums sumsOf(const py::tuple& state)
{
    if (state.size() != 8 && state.size() != 9)
        throw py::value_error("these are no sums of passes");
    PassSums sums;
    sums.width = py::cast<int>(state[0]);
    sums.height = py::cast<int>(state[1]);
    sums.passes = py::cast<std::string>(state[2]);
    sums.picture = py::cast<std::string>(state[3]);
    sums.low = valuesOf<std::int64_t>(state[4]);
    sums.high = valuesOf<std::int64_t>(state[5]);
    sums.depth = valuesOf<float>(state[6]);
    sums.displayReferred = py::cast<bool>(state[7]);
    sums.veiled = state.size() > 8 && py::cast<bool>(state[8]);
    return sums;
}

void add(PassSums& sums, const PassSums& other)
{
    const std::string problem = sums.add(other);
    if (!problem.empty()) throw py::value_error(problem);
}

py::array color(const PassSums& sums)
{
    const osg::ref_ptr<osg::Image> image = sums.getColorImage();
    if (!image) throw py::value_error("the sums of passes are empty or damaged");
    return pictureArray(image);
}

} // namespace

void bindPassSums(py::module_& module)
{
    py::class_<PassSums>(
        module, "PassSums",
        "Exact sums of some passes of a picture. Sums of different passes of the same\n"
        "picture, of several machines too, are joined to the bits that one machine\n"
        "gives. They can be pickled.")
        .def("add", &add, py::arg("other"),
             "Adds passes of the same picture. Raises ValueError if the pictures differ.")
        .def("color", &color, "Picture of these passes, as Renderer.color() has it.")
        .def_property_readonly(
            "passes", [](const PassSums& sums) { return text(sums.passes); },
            "Numbers of the passes: \"0-127,136-143\".")
        .def_property_readonly(
            "pass_count", [](const PassSums& sums) { return sums.passCount(); },
            "Number of the passes.")
        .def(py::pickle(&stateOf, &sumsOf));
}

} // namespace osgRayTrace::python
