// SegmentRectangles.cpp - sixteen stretches and a rectangle at once. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SegmentRectangles.h"

namespace osgRayTrace::engine
{

OSGRAYTRACE_KERNEL
LaneMask rectangleLanes(const ShiningRectangle& light, const RayBlock& ray, StretchLanes& stretches,
                        LightLanes& samples)
{
    const ShiningRectangle rectangle = light;
    LaneMask lit = 0;
    OSGRAYTRACE_SIMD_OR(lit)
    for (int i = 0; i < kLanes; ++i)
        lit |= bitOfLane(rectangleLane(rectangle, ray, i, stretches, samples), i);
    return lit;
}

} // namespace osgRayTrace::engine
