// LightBounds.h - bounds of the light that some lights send to a point. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

#include <cmath>

namespace osgRayTrace::engine
{

struct LightBounds
{
    Vec3 low{0.0f}, high{0.0f};
    Vec3 axis{0.0f, 0.0f, 1.0f};    ///< unit
    float cosCone = 1.0f;           ///< cosine of o
    float cosEmission = 0.0f;       ///< cosine of e
    float intensity = 0.0f;         ///< along the normals [W/sr]
    Vec3 falloff{0.0f, 0.0f, 1.0f}; ///< c, l and q, averages by intensity
    float range = kInfinity;        ///< from the box [length]: no light comes farther
    bool twoSided = false;
};

/// Returns bounds of the lights of both.
LightBounds joined(const LightBounds& a, const LightBounds& b);

/// LightNode holds LightBounds as words, which sixteen lanes read four by four. Nodes of areas are
/// told by the first twelve.
struct LightNode
{
    float centre[3];
    float radius;
    float axis[3];
    float cosCone;
    uint32_t extents; ///< half extents of the box: see packedExtents()
    float intensity;  ///< negative if some of the lights shine to both sides
    uint32_t next;    ///< the pair of children, or kLeaf and the emitter
    float cosEmission;
    float falloff[3];
    float reach; ///< from the centre [length]: no light comes farther
};
static_assert(sizeof(LightNode) == 64, "a node is a cache line");

LightNode nodeOf(const LightBounds& bounds, uint32_t next);

OSGRAYTRACE_INLINE float least(float a, float b)
{
    return select(a < b, a, b);
}

OSGRAYTRACE_INLINE float largest(float a, float b)
{
    return select(a > b, a, b);
}

OSGRAYTRACE_INLINE float sineOf(float cosine)
{
    const float square = 1.0f - cosine * cosine;
    return std::sqrt(select(square > 0.0f, square, 0.0f));
}

} // namespace osgRayTrace::engine
