// LightTreeLanes.cpp - sixteen points descend a light tree at once. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTree.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Takes lane i from a pair to one of its nodes, if it has not come to an emitter yet. Returns all
/// bits if it goes on.
template <NodeLights kLights>
OSGRAYTRACE_INLINE uint32_t descendLane(const LightNode* nodes, const Vec3Lanes& p,
                                        const Vec3Lanes& normal, int i, FloatLanes& u,
                                        UintLanes& at, FloatLanes& pmf)
{
    const uint32_t open = maskOf((at[i] & LightPairs::kLeaf) == 0);
    const uint32_t node = 2 * (at[i] & open);
    const float share =
        shareOfFirst<kLights>(nodes[node], nodes[node + 1], plainOf(p, i), plainOf(normal, i));
    const uint32_t first = maskOf(u[i] < share);
    const float own = select(first, share, 1.0f - share);
    const float rescaled = (u[i] - select(first, 0.0f, share)) / own;
    const float below = select(rescaled < kOneMinusEpsilon, rescaled, kOneMinusEpsilon);
    const uint32_t next = nodes[node + 1 - (first & 1u)].next;
    u[i] = select(open, below, u[i]);
    pmf[i] = select(open, pmf[i] * own, pmf[i]);
    at[i] = (next & open) | (at[i] & ~open);
    return maskOf((at[i] & LightPairs::kLeaf) == 0);
}

OSGRAYTRACE_KERNEL
LaneMask descend(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal, FloatLanes& u,
                 UintLanes& at, FloatLanes& pmf)
{
    LaneMask open = 0;
    OSGRAYTRACE_SIMD_OR(open)
    for (int i = 0; i < kLanes; ++i)
        open |= bitOfLane(descendLane<NodeLights::Any>(nodes, p, normal, i, u, at, pmf), i);
    return open;
}

/// Does what descend does, in a tree without point lights.
OSGRAYTRACE_KERNEL
LaneMask descendAreas(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal,
                      FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    LaneMask open = 0;
    OSGRAYTRACE_SIMD_OR(open)
    for (int i = 0; i < kLanes; ++i)
        open |= bitOfLane(descendLane<NodeLights::Areas>(nodes, p, normal, i, u, at, pmf), i);
    return open;
}

} // namespace

void LightTree::chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, FloatLanes& u,
                            UintLanes& emitters, FloatLanes& pmf) const
{
    for (int i = 0; i < kLanes; ++i)
    {
        emitters[i] = 0;
        pmf[i] = 1.0f;
    }
    const auto step = _areasOnly ? descendAreas : descend;
    while (step(_arrays.nodes.data(), p, normal, u, emitters, pmf) != 0)
    {
    }
    for (int i = 0; i < kLanes; ++i)
        emitters[i] &= ~LightPairs::kLeaf;
}

} // namespace osgRayTrace::engine
