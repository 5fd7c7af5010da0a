// Bindings.h - the parts of the module, each in a file of its own. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace osgRayTrace::python
{

void bindErrors(pybind11::module_& module);
void bindScene(pybind11::module_& module);
void bindSettings(pybind11::module_& module);
void bindPassSums(pybind11::module_& module);
void bindRenderer(pybind11::module_& module); ///< after the classes that it names

} // namespace osgRayTrace::python
