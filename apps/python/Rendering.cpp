// Rendering.cpp - renders without the interpreter's lock; calls Python between passes. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Rendering.h"

#include "StatisticsDict.h"

#include <chrono>
#include <cstdlib>
#include <exception>

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

constexpr int kDefaultPasses = 64; ///< as osgraytrace has it
constexpr int kUnlimitedPasses = 1 << 24;
const char* const kMaxPasses = "max-passes";
const char* const kMaterials = "materials";
constexpr std::chrono::milliseconds kSignalInterval(50);

std::string defaultOf(const std::string& name)
{
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
        if (option.name == name) return option.defaultValue;
    return {};
}

/// Sets a flag while it exists.
class Raised
{
public:
    explicit Raised(bool& flag) : _flag(flag) { _flag = true; }
    ~Raised() { _flag = false; }

private:
    bool& _flag;
};

} // namespace

Rendering::Rendering(ScenePointer scene, int width, int height)
    : _scene(std::move(scene)), _renderer(new Renderer), _width(width), _height(height)
{
    const osg::ref_ptr<RayTraceSettings> settings = _scene->settings();
    _passesStated =
        std::getenv("OSGRAYTRACE_MAX_PASSES") || settings->get(kMaxPasses) != defaultOf(kMaxPasses);
    _renderer->setScene(&_scene->node());
    _renderer->setSettings(settings.get());
    _renderer->setSize(width, height);
    if (const auto color = app::storedClearColor(_scene->node())) _renderer->setClearColor(*color);
    if (_scene->placement()) _view = *_scene->placement();
}

Statistics Rendering::render(double seconds, double relativeError, const py::object& progress,
                             const py::object& shutter)
{
    std::exception_ptr raised; // Renderer would make a message of it
    auto asked = std::chrono::steady_clock::now();
    const auto betweenPasses = [&](const Statistics& statistics)
    {
        // Other threads of Python keep its lock for milliseconds: it is not taken for each pass.
        const auto now = std::chrono::steady_clock::now();
        if (raised || OutsidePython::isEnding()) return false;
        if (progress.is_none() && now - asked < kSignalInterval) return true;
        asked = now;
        const py::gil_scoped_acquire inside;
        try
        {
            return goesOn(statistics, progress);
        }
        catch (...)
        {
            raised = std::current_exception();
            return false;
        }
    };
    const auto pose = [&](double moment)
    {
        if (raised || OutsidePython::isEnding()) return;
        try
        {
            const py::gil_scoped_acquire inside;
            shutter(moment);
        }
        catch (...)
        {
            raised = std::current_exception();
            _renderer->cancel();
        }
        placeView();
    };
    const Statistics statistics = alone(
        [&](Renderer& renderer)
        {
            if (_rendering) throw RenderFailure("a progress function cannot render");
            const Raised rendering(_rendering);
            limitPasses(seconds > 0.0 || relativeError > 0.0);
            placeView();
            const StoppableRender stoppable(renderer);
            const auto view = _view;
            if (!shutter.is_none()) renderer.setShutter(pose);
            renderer.render(seconds, relativeError, betweenPasses);
            renderer.setShutter({});
            _view = view;
            return renderer.getStatistics();
        });
    if (raised) std::rethrow_exception(raised);
    if (!statistics.ok) throw RenderFailure(statistics.message);
    return statistics;
}

/// Lets Python look at signals, as Ctrl-C is one, and asks progress.
bool Rendering::goesOn(const Statistics& statistics, const py::object& progress)
{
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress.is_none()) return true;
    const py::object answer = progress(statisticsDict(statistics));
    return answer.is_none() || py::bool_(answer);
}

/// Unless somebody has stated a limit, there is one of 64 passes, or none beside another limit.
void Rendering::limitPasses(bool otherwiseLimited)
{
    if (_passesStated) return;
    _renderer->getSettings()->setMaxPasses(otherwiseLimited ? kUnlimitedPasses : kDefaultPasses);
}

void Rendering::placeView()
{
    if (_width <= 0 || _height <= 0) return; // render() says so
    const Matrices now = presentView();
    _renderer->setViewMatrix(now.view);
    _renderer->setProjectionMatrix(now.projection);
}

Matrices Rendering::presentView() const
{
    if (const Matrices* matrices = std::get_if<Matrices>(&_view)) return *matrices;
    osg::Node& node = _scene->node();
    const app::Placement* placed = std::get_if<app::Placement>(&_view);
    const app::Placement placement =
        placed ? *placed : app::homePlacement(node, _width, _height, app::kOsgViewerFovyDegrees);
    const app::Camera camera = app::cameraAt(placement, node, double(_width) / _height);
    return {camera.view, camera.projection};
}

void Rendering::setPlacement(const app::Placement& placement)
{
    alone([&](Renderer&) { _view = placement; });
}

void Rendering::setMatrices(const Matrices& matrices)
{
    alone([&](Renderer&) { _view = matrices; });
}

Matrices Rendering::matrices()
{
    return alone(
        [&](Renderer& renderer)
        {
            placeView();
            return Matrices{renderer.getViewMatrix(), renderer.getProjectionMatrix()};
        });
}

int Rendering::width()
{
    return alone([&](Renderer&) { return _width; });
}

int Rendering::height()
{
    return alone([&](Renderer&) { return _height; });
}

void Rendering::setSize(int width, int height)
{
    alone(
        [&](Renderer& renderer)
        {
            _width = width;
            _height = height;
            renderer.setSize(width, height);
        });
}

std::string Rendering::set(const std::string& name, const std::string& value)
{
    return alone(
        [&](Renderer& renderer) -> std::string
        {
            RayTraceSettings& settings = *renderer.getSettings();
            const std::string before = settings.get(name);
            if (!settings.set(name, value)) return "it is not one of its values";
            const std::string problem =
                name == kMaterials ? settings.getMaterialsError() : std::string();
            if (!problem.empty()) settings.set(name, before);
            if (name == kMaxPasses) _passesStated = true;
            return problem;
        });
}

std::string Rendering::get(const std::string& name)
{
    return alone([&](Renderer& renderer) { return renderer.getSettings()->get(name); });
}

} // namespace osgRayTrace::python
