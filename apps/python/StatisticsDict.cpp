// StatisticsDict.cpp - names the members of Statistics. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StatisticsDict.h"

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

py::object valueOf(bool value)
{
    return py::bool_(value);
}
py::object valueOf(int value)
{
    return py::int_(value);
}
py::object valueOf(uint64_t value)
{
    return py::int_(value);
}
py::object valueOf(double value)
{
    return py::float_(value);
}
py::object valueOf(const std::string& value)
{
    return text(value);
}

py::object valueOf(const std::vector<std::string>& values)
{
    py::list list;
    for (const std::string& value : values)
        list.append(text(value));
    return std::move(list);
}

template <typename T> py::object valueOf(const std::map<std::string, T>& values)
{
    py::dict dict;
    for (const auto& [key, value] : values)
        dict[text(key)] = valueOf(value);
    return std::move(dict);
}

} // namespace

py::str text(const std::string& bytes)
{
    PyObject* decoded =
        PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace");
    if (!decoded) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(decoded);
}

py::dict statisticsDict(const Statistics& statistics)
{
    const Statistics& s = statistics;
    py::dict dict;
#define OSGRAYTRACE_MEMBER(name) dict[#name] = valueOf(s.name)
    OSGRAYTRACE_MEMBER(ok);
    OSGRAYTRACE_MEMBER(message);
    OSGRAYTRACE_MEMBER(triangles);
    OSGRAYTRACE_MEMBER(meshes);
    OSGRAYTRACE_MEMBER(instances);
    OSGRAYTRACE_MEMBER(lights);
    OSGRAYTRACE_MEMBER(convertSeconds);
    OSGRAYTRACE_MEMBER(buildSeconds);
    OSGRAYTRACE_MEMBER(embreeBytes);
    OSGRAYTRACE_MEMBER(conversion);
    OSGRAYTRACE_MEMBER(conversionPaths);
    OSGRAYTRACE_MEMBER(walks);
    OSGRAYTRACE_MEMBER(conversions);
    OSGRAYTRACE_MEMBER(lastConversionReason);
    OSGRAYTRACE_MEMBER(lastConversionPath);
    OSGRAYTRACE_MEMBER(patches);
    OSGRAYTRACE_MEMBER(convertedMeshes);
    OSGRAYTRACE_MEMBER(builtMeshes);
    OSGRAYTRACE_MEMBER(refitMeshes);
    OSGRAYTRACE_MEMBER(staticBuilds);
    OSGRAYTRACE_MEMBER(embreeCommits);
    OSGRAYTRACE_MEMBER(integrator);
    OSGRAYTRACE_MEMBER(passes);
    OSGRAYTRACE_MEMBER(imageShare);
    OSGRAYTRACE_MEMBER(lightNote);
    OSGRAYTRACE_MEMBER(renderSeconds);
    OSGRAYTRACE_MEMBER(relativeError);
    OSGRAYTRACE_MEMBER(medianError);
    OSGRAYTRACE_MEMBER(worstErrorShare);
    OSGRAYTRACE_MEMBER(cameraRays);
    OSGRAYTRACE_MEMBER(shadowRays);
    OSGRAYTRACE_MEMBER(secondaryRays);
    OSGRAYTRACE_MEMBER(photonRays);
    OSGRAYTRACE_MEMBER(storedPhotons);
    OSGRAYTRACE_MEMBER(storedBeams);
    OSGRAYTRACE_MEMBER(storedPoints);
    OSGRAYTRACE_MEMBER(beamRadius);
    OSGRAYTRACE_MEMBER(photonBytes);
    OSGRAYTRACE_MEMBER(hitPointBytes);
    OSGRAYTRACE_MEMBER(autoExposure);
    OSGRAYTRACE_MEMBER(reprojectedShare);
    OSGRAYTRACE_MEMBER(reprojectSeconds);
    OSGRAYTRACE_MEMBER(photonRadius);
    OSGRAYTRACE_MEMBER(photonNote);
    OSGRAYTRACE_MEMBER(collisions);
    OSGRAYTRACE_MEMBER(cutWalks);
    OSGRAYTRACE_MEMBER(openWalks);
    OSGRAYTRACE_MEMBER(mediumNote);
    OSGRAYTRACE_MEMBER(denoiseMilliseconds);
    OSGRAYTRACE_MEMBER(denoiser);
    OSGRAYTRACE_MEMBER(denoiseNote);
    OSGRAYTRACE_MEMBER(droppedSamples);
#undef OSGRAYTRACE_MEMBER
    return dict;
}

} // namespace osgRayTrace::python
