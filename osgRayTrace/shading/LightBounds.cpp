// LightBounds.cpp - joins bounds of lights. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightNodes.h"

namespace osgRayTrace::engine
{

LightBounds joined(const LightBounds& a, const LightBounds& b)
{
    return boundsOf(joinedBounds(plainOf(a), plainOf(b)));
}

LightNode nodeOf(const LightBounds& bounds, uint32_t next)
{
    const PlainBounds b = plainOf(bounds);
    const PlainVec3 centre = centreOf(b);
    const float radius = radiusAround(centre, b);
    return {{centre.x, centre.y, centre.z},
            radius,
            {b.axis.x, b.axis.y, b.axis.z},
            b.cosCone,
            packedExtents(b, radius),
            b.intensity,
            next,
            b.cosEmission,
            {b.falloff.x, b.falloff.y, b.falloff.z},
            (b.range + radius) * kReachSlack};
}

} // namespace osgRayTrace::engine
