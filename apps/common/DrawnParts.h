// DrawnParts.h - what of a scene is not in the traced radiance of its picture. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Statistics>

#include <cstdint>

namespace osgRayTrace::app
{

/// Parts of the scene that OSG draws where there is a context, and nobody where there is none.
uint64_t partsDrawnByOsg(const Statistics& statistics);

} // namespace osgRayTrace::app
