// Rendering.h - a Renderer for Python: its view, and one thread at a time. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "LoadedScene.h"
#include "OutsidePython.h"

#include <osgRayTrace/Renderer>

#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

namespace osgRayTrace::python
{

/// Reports that nothing could be rendered: Python's RenderError.
class RenderFailure : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

struct Matrices
{
    osg::Matrixd view;
    osg::Matrixd projection;
};

/// Owns a Renderer. Any Python thread may call any function: functions wait for each other, and
/// cancel() waits for none. They are called with the interpreter's lock and give it up as they wait
/// and work.
class Rendering
{
public:
    Rendering(ScenePointer scene, int width, int height);

    const ScenePointer& scene() const { return _scene; }

    /// Calls a function of the renderer, without the interpreter's lock and without any other
    /// thread in it. The function must not touch objects of Python.
    template <typename Call> auto alone(const Call& call)
    {
        const OutsidePython outside;
        const std::lock_guard<std::recursive_mutex> lock(_mutex);
        return call(*_renderer);
    }

    /// Renders, and returns the statistics. progress: called with the statistics as a dictionary,
    /// or None. shutter: called before each pass with its moment in [0, 1) to set the view of the
    /// pass, or None; the view is afterwards what it was. Throws RenderFailure, and whatever these
    /// functions throw.
    Statistics render(double seconds, double relativeError, const pybind11::object& progress,
                      const pybind11::object& shutter);
    void cancel() { _renderer->cancel(); }

    /// Sets the view of the next render.
    void setPlacement(const app::Placement& placement);
    void setMatrices(const Matrices& matrices);

    /// Returns the matrices of the next render.
    Matrices matrices();

    int width(), height();
    void setSize(int width, int height);

    /// Sets an option, by the name that the option table has, from text. Returns why that cannot
    /// be, and changes nothing then; otherwise empty.
    std::string set(const std::string& name, const std::string& value);
    std::string get(const std::string& name);

private:
    bool goesOn(const Statistics& statistics, const pybind11::object& progress);
    void limitPasses(bool otherwiseLimited);
    void placeView();
    Matrices presentView() const;

    ScenePointer _scene;
    osg::ref_ptr<Renderer> _renderer;
    std::recursive_mutex _mutex; ///< guards the following members, and all of the renderer's work
    int _width, _height;
    std::variant<std::monostate, app::Placement, Matrices> _view; ///< monostate: the home view
    bool _passesStated; ///< whether somebody has stated a limit of passes
    bool _rendering = false;
};

} // namespace osgRayTrace::python
