// Module.cpp - the native part of Python's package osgraytrace. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Bindings.h"
#include "OutsidePython.h"
#include "Rendering.h"
#include "StatisticsDict.h"

#include "apps/common/Failure.h"
#include "osgPlugins/OwnFolder.h"

#include <osgRayTrace/Version>

namespace osgRayTrace::python
{

namespace py = pybind11;

namespace
{

/// Lets osgDB find our plugins, which are beside the library: in the build tree, where it is
/// installed, and in a package.
void preferPlugins()
{
    const auto library = engine::folderOf(reinterpret_cast<const void*>(&osgRayTraceGetVersion));
    if (!library.empty()) engine::preferFolder(library);
}

} // namespace

void bindErrors(py::module_& module)
{
    static py::handle loadError, renderError; // exceptions live as long as the interpreter
    loadError = PyErr_NewExceptionWithDoc("osgraytrace.LoadError", "A model cannot be read.",
                                          PyExc_RuntimeError, nullptr);
    renderError = PyErr_NewExceptionWithDoc("osgraytrace.RenderError", "Nothing can be rendered.",
                                            PyExc_RuntimeError, nullptr);
    module.attr("LoadError") = loadError;
    module.attr("RenderError") = renderError;
    py::register_exception_translator(
        [](std::exception_ptr thrown)
        {
            try
            {
                if (thrown) std::rethrow_exception(thrown);
            }
            catch (const app::Failure& failure)
            {
                PyErr_SetObject(loadError.ptr(), text(failure.what()).ptr());
            }
            catch (const RenderFailure& failure)
            {
                PyErr_SetObject(renderError.ptr(), text(failure.what()).ptr());
            }
        });
}

} // namespace osgRayTrace::python

PYBIND11_MODULE(_osgraytrace, module)
{
    using namespace osgRayTrace::python;
    preferPlugins();
    module.doc() = "Native part of osgraytrace.";
    module.attr("__version__") = osgRayTraceGetVersion();
    bindErrors(module);
    bindScene(module);
    bindSettings(module);
    bindPassSums(module);
    bindRenderer(module);
    pybind11::module_::import("atexit").attr("register")(
        pybind11::cpp_function(&OutsidePython::endAll));
}
