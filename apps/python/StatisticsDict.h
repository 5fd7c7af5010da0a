// StatisticsDict.h - statistics as a dictionary. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <osgRayTrace/Statistics>

#include <string>

namespace osgRayTrace::python
{

/// Returns a text; names in models may be of any encoding, and bytes that are no UTF-8 are
/// replaced.
pybind11::str text(const std::string& bytes);

/// Returns the members by their C++ names, but for those that only a view on a screen has.
pybind11::dict statisticsDict(const Statistics& statistics);

} // namespace osgRayTrace::python
