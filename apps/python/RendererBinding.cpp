// RendererBinding.cpp - Python's class Renderer. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Bindings.h"
#include "MatrixArray.h"
#include "PictureArray.h"
#include "SettingsBinding.h"
#include "StatisticsDict.h"

#include <pybind11/stl.h>

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

using Size = std::pair<int, int>;
using Vector = std::array<double, 3>;

constexpr const char* kChannels[] = {"depth",    "distance", "normal", "albedo",
                                     "position", "id",       "error"};

std::shared_ptr<Rendering> newRenderer(const py::object& scene, const Size& size,
                                       const py::kwargs& settings)
{
    // A name of a file is a scene of that file.
    const py::object loaded =
        py::isinstance<LoadedScene>(scene) ? scene : py::type::of<LoadedScene>()(scene);
    auto rendering = std::make_shared<Rendering>(py::cast<std::shared_ptr<LoadedScene>>(loaded),
                                                 size.first, size.second);
    for (const auto& [name, value] : settings)
        setOption(*rendering, py::cast<std::string>(name), value);
    return rendering;
}

void lookAt(Rendering& rendering, const Vector& eye, const Vector& center, const Vector& up,
            double fovy)
{
    app::Placement placement;
    placement.eye = vectorOf(eye, "eye");
    placement.center = vectorOf(center, "center");
    placement.up = vectorOf(up, "up");
    placement.fovyDegrees = fovy;
    if (!(fovy > 0.0 && fovy < 180.0))
        throw py::value_error("fovy is not an angle between 0 and 180 degrees");
    const std::string problem = app::whyNoView(placement, "");
    if (!problem.empty()) throw py::value_error(problem);
    rendering.setPlacement(placement);
}

void useCamera(Rendering& rendering, const std::string& name)
{
    std::string names;
    for (const app::NamedPlacement& camera : rendering.scene()->cameras())
    {
        if (camera.name == name) return rendering.setPlacement(camera.placement);
        names += (names.empty() ? "" : ", ") + camera.name;
    }
    throw py::value_error("there is no camera '" + name + "'; the model's cameras are " +
                          (names.empty() ? "none" : names));
}

py::dict render(Rendering& rendering, double seconds, double error, const py::object& progress,
                const py::object& shutter)
{
    if (!(seconds >= 0.0)) throw py::value_error("seconds is not a number from 0 on");
    if (!(error >= 0.0)) throw py::value_error("error is not a number from 0 on");
    if (!progress.is_none() && !PyCallable_Check(progress.ptr()))
        throw py::type_error("progress is neither a function nor None");
    if (!shutter.is_none() && !PyCallable_Check(shutter.ptr()))
        throw py::type_error("shutter is neither a function nor None");
    return statisticsDict(rendering.render(seconds, error, progress, shutter));
}

/// Returns the array of an image that get() makes. Throws RenderFailure before the first render.
template <typename Get> py::array picture(Rendering& rendering, const Get& get)
{
    const osg::ref_ptr<osg::Image> image = rendering.alone(
        [&](Renderer& renderer)
        {
            if (renderer.getStatistics().imageShare <= 0.0)
                throw RenderFailure("there is no picture yet; render() makes it");
            return get(renderer);
        });
    return pictureArray(image);
}

py::array channel(Rendering& rendering, const std::string& name)
{
    std::string names;
    for (const char* known : kChannels)
    {
        if (name == known)
            return picture(rendering, [&](Renderer& r) { return r.getChannelImage(name); });
        names += (names.empty() ? "" : ", ") + std::string(known);
    }
    throw py::value_error("there is no channel '" + name + "'; the channels are " + names);
}

py::list idPaths(Rendering& rendering)
{
    const std::vector<std::string> paths =
        rendering.alone([](Renderer& renderer) { return renderer.getIdPaths(); });
    py::list list;
    for (const std::string& path : paths)
        list.append(text(path));
    return list;
}

PassSums passSums(Rendering& rendering)
{
    return rendering.alone([](Renderer& renderer) { return renderer.getPassSums(); });
}

void bindViews(py::class_<Rendering, std::shared_ptr<Rendering>>& renderer)
{
    renderer
        .def("look_at", &lookAt, py::arg("eye"), py::arg("center"),
             py::arg("up") = Vector{0.0, 0.0, 1.0}, py::arg("fovy") = app::kOsgViewerFovyDegrees,
             "Places the camera; fovy is the vertical field of view in degrees. Near and far "
             "planes\n"
             "are set around the scene.")
        .def("use_camera", &useCamera, py::arg("name"),
             "Takes the view of a camera of the model: see Scene.cameras.")
        .def(
            "set_matrices",
            [](Rendering& rendering, const MatrixArray& view, const MatrixArray& projection) {
                rendering.setMatrices({matrixOf(view, "view"), matrixOf(projection, "projection")});
            },
            py::arg("view"), py::arg("projection"),
            "Sets both matrices, 4 x 4 numbers that are applied to columns: view @ [x, y, z, 1], "
            "as\n"
            "numpy has it. OSG's own matrices are the transposed ones.")
        .def_property_readonly(
            "view_matrix", [](Rendering& rendering) { return arrayOf(rendering.matrices().view); },
            "View matrix of the next render, for columns.")
        .def_property_readonly(
            "projection_matrix",
            [](Rendering& rendering) { return arrayOf(rendering.matrices().projection); },
            "Projection matrix of the next render, for columns.");
}

void bindImages(py::class_<Rendering, std::shared_ptr<Rendering>>& renderer)
{
    renderer
        .def(
            "color",
            [](Rendering& rendering)
            { return picture(rendering, [](Renderer& r) { return r.getColorImage(); }); },
            "Linear radiance: float32, (height, width, 4). Alpha is coverage, and colours are\n"
            "multiplied with it. Row 0 is at the top of the picture.")
        .def(
            "display",
            [](Rendering& rendering)
            { return picture(rendering, [](Renderer& r) { return r.getDisplayImage(); }); },
            "Picture as it is shown, over the clear colour: uint8, (height, width, 4).")
        .def("channel", &channel, py::arg("name"),
             "One of Renderer.channels: float32, (height, width) for depth, distance and id, and\n"
             "(height, width, 3) for the others.");
    renderer.def("id_paths", &idPaths,
                 "Node paths of the numbers in the channel id of the last picture: [\"\",\n"
                 "\"root/arm/hand\", ...]. Those of the background and of lamps are empty.");
    py::tuple channels(std::size(kChannels));
    for (std::size_t i = 0; i < std::size(kChannels); ++i)
        channels[i] = kChannels[i];
    renderer.attr("channels") = channels;
}

void bindSums(py::class_<Rendering, std::shared_ptr<Rendering>>& renderer)
{
    renderer
        .def(
            "set_first_pass",
            [](Rendering& rendering, int first)
            { rendering.alone([&](Renderer& r) { r.setFirstPass(first); }); },
            py::arg("first"),
            "Leaves the passes before this one to others; max-passes is the one after the last.")
        .def(
            "set_whole_passes",
            [](Rendering& rendering, bool on)
            { rendering.alone([&](Renderer& r) { r.setWholePasses(on); }); },
            py::arg("on"),
            "Whether render() ends between passes only, so that pass_sums() has all.")
        .def("pass_sums", &passSums, "Exact sums of the last render, to be kept, sent and joined.")
        .def(
            "set_pass_sums",
            [](Rendering& rendering, const PassSums& sums)
            { rendering.alone([&](Renderer& r) { r.setPassSums(sums); }); },
            py::arg("sums"),
            "Lets the next render() begin with these passes and add those that are missing.");
}

} // namespace

void bindRenderer(py::module_& module)
{
    py::class_<Rendering, std::shared_ptr<Rendering>> renderer(
        module, "Renderer",
        "Ray traces a scene to numpy arrays, without a display. Several renderers may render at\n"
        "once, each on one thread at a time; other threads wait. Equal seeds give equal pictures.");
    renderer
        .def(py::init(&newRenderer), py::arg("scene"), py::arg("size") = Size(1280, 720),
             "Renderer(scene, size=(width, height), **settings)\n\n"
             "scene: a Scene or the name of a file. settings: options by name, "
             "integrator=\"path\".\n"
             "The view is the one that osgviewer opens with, or the one that the model asks for.")
        .def("render", &render, py::arg("seconds") = 0.0, py::arg("error") = 0.0,
             py::arg("progress") = py::none(), py::arg("shutter") = py::none(),
             "Renders until max-passes (64 unless it is set, or one of the others is given), for\n"
             "seconds, or to an estimated relative error; returns the statistics. A second render "
             "of\n"
             "the same view adds to the first. progress is called between passes with the\n"
             "statistics and ends the render by returning False. shutter opens a shutter, for "
             "motion\n"
             "blur: it is called before each pass with the moment of the pass, in [0, 1) of the "
             "time\n"
             "that the shutter is open, and places the camera there, by look_at() or "
             "set_matrices().\n"
             "The first and the last moment come once more before the passes. Every such render "
             "begins\n"
             "a new picture, and leaves the view as it was. Raises RenderError.")
        .def("cancel", &Rendering::cancel, "Stops a render() of another thread within a tile.")
        .def_property_readonly(
            "statistics",
            [](Rendering& rendering) {
                return statisticsDict(
                    rendering.alone([](Renderer& r) { return r.getStatistics(); }));
            },
            "Statistics of the last render, by the names of osgRayTrace's C++.")
        .def_property_readonly(
            "settings",
            [](const std::shared_ptr<Rendering>& rendering) { return Settings{rendering}; },
            "Options by name: see Settings.")
        .def_property_readonly(
            "scene",
            [](const Rendering& rendering)
            { return std::const_pointer_cast<LoadedScene>(rendering.scene()); },
            "Scene that is rendered.")
        .def_property(
            "size",
            [](Rendering& rendering) { return Size(rendering.width(), rendering.height()); },
            [](Rendering& rendering, const Size& size)
            { rendering.setSize(size.first, size.second); },
            "(width, height) in pixels of the next render.")
        .def(
            "set_clear_color",
            [](Rendering& rendering, const std::array<float, 4>& c) {
                rendering.alone([&](Renderer& r)
                                { r.setClearColor(osg::Vec4(c[0], c[1], c[2], c[3])); });
            },
            py::arg("rgba"), "Sets the colour of pixels in which nothing is hit, as shown.")
        .def(
            "set_headlight",
            [](Rendering& rendering, bool on)
            { rendering.alone([&](Renderer& r) { r.setHeadlight(on); }); },
            py::arg("on"),
            "Whether a scene without a light gets one at the eye, as in osgviewer. Default True.");
    bindViews(renderer);
    bindImages(renderer);
    bindSums(renderer);
}

} // namespace osgRayTrace::python
