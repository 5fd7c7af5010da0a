// LightBounds.cpp - joins bounds of lights. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightNodes.h"

namespace osgRayTrace::engine
{

LightBounds joined(const LightBounds& a, const LightBounds& b)
{
    return joinedBounds(a, b);
}

LightNode nodeOf(const LightBounds& bounds, uint32_t next)
{
    LightNode node;
    setNode(node, bounds, next);
    return node;
}

} // namespace osgRayTrace::engine
