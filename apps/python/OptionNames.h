// OptionNames.h - finds options by names as Python spells them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <osgRayTrace/RayTraceSettings>

#include <string>

namespace osgRayTrace::python
{

/// Returns the option of a name: "max_passes", "max-passes", "maxPasses" or "passes". Throws
/// pybind11::value_error, which names the most similar option, if there is none.
RayTraceSettings::Option optionOf(const std::string& name);

/// Returns the text of a value: of a str, a bool, an int or a float. Throws pybind11::type_error.
std::string optionText(const pybind11::handle& value);

/// Returns the value of a text: bool, int or float if the option takes these, otherwise str.
pybind11::object optionValue(const RayTraceSettings::Option& option, const std::string& text);

} // namespace osgRayTrace::python
