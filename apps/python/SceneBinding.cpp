// SceneBinding.cpp - Python's class Scene. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Bindings.h"
#include "LoadedScene.h"
#include "OutsidePython.h"
#include "StatisticsDict.h"

#include <pybind11/stl.h>

#include <algorithm>

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

/// Returns the name of a file as the system has it, of a string, bytes or an os.PathLike.
std::string fileName(const py::handle& name)
{
    PyObject* encoded = nullptr;
    if (!PyUnicode_FSConverter(name.ptr(), &encoded)) throw py::error_already_set();
    return py::reinterpret_steal<py::bytes>(encoded);
}

ScenePointer sceneOf(const py::args& names)
{
    std::vector<std::string> files;
    for (const py::handle& name : names)
        files.push_back(fileName(name));
    const OutsidePython outside;
    return sceneOfFiles(files);
}

ScenePointer sceneFromText(const std::string& text)
{
    const OutsidePython outside;
    return sceneOfText(text);
}

py::tuple boundOf(const LoadedScene& scene)
{
    const osg::BoundingSphere& bound = scene.bound();
    const osg::BoundingSphere::vec_type& center = bound.center();
    return py::make_tuple(py::make_tuple(center.x(), center.y(), center.z()),
                          std::max(bound.radius(), osg::BoundingSphere::value_type(0)));
}

py::list cameraNames(const LoadedScene& scene)
{
    py::list names;
    for (const app::NamedPlacement& camera : scene.cameras())
        names.append(text(camera.name));
    return names;
}

} // namespace

void bindScene(py::module_& module)
{
    py::class_<LoadedScene, std::shared_ptr<LoadedScene>>(
        module, "Scene",
        "Models that OpenSceneGraph reads. A scene does not change; any number of renderers, on "
        "any\n"
        "threads, may have it.")
        .def(py::init([](const py::args& names)
                      { return std::const_pointer_cast<LoadedScene>(sceneOf(names)); }),
             "Scene(*files): reads one model, or several into one scene.\n\n"
             "Raises LoadError if a file cannot be read.")
        .def_static(
            "from_text",
            [](const std::string& text)
            { return std::const_pointer_cast<LoadedScene>(sceneFromText(text)); },
            py::arg("text"), "Reads a text in the format of .osgt files.")
        .def_property_readonly("bound", &boundOf,
                               "Sphere around the scene: ((x, y, z), radius); radius 0: nothing.")
        .def_property_readonly("cameras", &cameraNames,
                               "Names of the cameras in the models, for Renderer.use_camera.");
}

} // namespace osgRayTrace::python
