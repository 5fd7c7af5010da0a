// DrawnParts.cpp - counts what is left to OSG. Layer: apps.
// SPDX-License-Identifier: MIT
#include "DrawnParts.h"

namespace osgRayTrace::app
{

uint64_t partsDrawnByOsg(const Statistics& statistics)
{
    uint64_t parts = 0;
    for (const auto& [what, count] : statistics.conversion)
        if (what.rfind("rasterized.", 0) == 0 || what.rfind("not-traced.", 0) == 0) parts += count;
    return parts;
}

} // namespace osgRayTrace::app
