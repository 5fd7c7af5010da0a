// SettingsBinding.h - the options of a renderer as Python sees them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Rendering.h"

#include <memory>
#include <string>

namespace osgRayTrace::python
{

/// Refers to the options of a renderer, which lives as long as this does.
struct Settings
{
    std::shared_ptr<Rendering> rendering;
};

/// Sets an option, spelt in any way, to a value of Python. Throws pybind11::value_error, which
/// names both.
void setOption(Rendering& rendering, const std::string& name, const pybind11::handle& value);

} // namespace osgRayTrace::python
