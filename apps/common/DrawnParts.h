// DrawnParts.h - parts of a scene that the traced radiance does not hold. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Statistics>

#include <cstdint>

namespace osgRayTrace::app
{

/// Returns the number of parts of the scene that OSG draws if there is a context, and that nobody
/// draws without one.
uint64_t partsDrawnByOsg(const Statistics& statistics);

} // namespace osgRayTrace::app
