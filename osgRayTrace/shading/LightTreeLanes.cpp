// LightTreeLanes.cpp - sixteen points descend a light tree at once. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTree.h"

#include "osgRayTrace/shading/LightImportance.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Takes lane i from a pair to one of its nodes, if it has not come to an emitter yet: to the first
/// with the probability share. first, second: what is below the nodes. Returns all bits if the lane
/// goes on.
OSGRAYTRACE_INLINE uint32_t takeNode(float share, uint32_t first, uint32_t second, int i,
                                     FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    const uint32_t open = maskOf((at[i] & LightPairs::kLeaf) == 0);
    const uint32_t isFirst = maskOf(u[i] < share);
    const float own = select(isFirst, share, 1.0f - share);
    const float rescaled = (u[i] - select(isFirst, 0.0f, share)) / own;
    const float below = select(rescaled < kOneMinusEpsilon, rescaled, kOneMinusEpsilon);
    const uint32_t next = (first & isFirst) | (second & ~isFirst);
    u[i] = select(open, below, u[i]);
    pmf[i] = select(open, pmf[i] * own, pmf[i]);
    at[i] = (next & open) | (at[i] & ~open);
    return maskOf((at[i] & LightPairs::kLeaf) == 0);
}

/// Does what takeNode does, with the pair that the lane has come to.
template <NodeLights kLights>
OSGRAYTRACE_INLINE uint32_t descendLane(const LightNode* nodes, const Vec3Lanes& p,
                                        const Vec3Lanes& normal, int i, FloatLanes& u,
                                        UintLanes& at, FloatLanes& pmf)
{
    const uint32_t open = maskOf((at[i] & LightPairs::kLeaf) == 0);
    const uint32_t node = 2 * (at[i] & open);
    const float share =
        shareOfFirst<kLights>(nodes[node], nodes[node + 1], plainOf(p, i), plainOf(normal, i));
    return takeNode(share, nodes[node].next, nodes[node + 1].next, i, u, at, pmf);
}

/// Sets the probabilities of the first node of one pair. All lanes read the same nodes: unlike a
/// step of descend nothing is gathered, which is most of its time.
OSGRAYTRACE_KERNEL
void setShares(const LightNode* pair, const Vec3Lanes& p, const Vec3Lanes& normal,
               FloatLanes& shares)
{
    const LightNode first = pair[0], second = pair[1];
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        shares[i] = shareOfFirst<NodeLights::Any>(first, second, plainOf(p, i), plainOf(normal, i));
}

/// Does what setShares does, in a tree without point lights.
OSGRAYTRACE_KERNEL
void setSharesOfAreas(const LightNode* pair, const Vec3Lanes& p, const Vec3Lanes& normal,
                      FloatLanes& shares)
{
    const LightNode first = pair[0], second = pair[1];
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        shares[i] =
            shareOfFirst<NodeLights::Areas>(first, second, plainOf(p, i), plainOf(normal, i));
}

/// The probabilities of the first nodes of the root's pair and of the two pairs below it.
struct TopShares
{
    FloatLanes root;
    FloatLanes below[2]; ///< of lanes that go to the root's first node, and to its second
    uint32_t next[2];    ///< below the root
    uint32_t after[4];   ///< below the root's first node, and its second
};

/// Takes the lanes from the root two levels down. Returns the lanes that go on.
OSGRAYTRACE_KERNEL
LaneMask descendTop(const TopShares& top, FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    const uint32_t first = top.next[0], second = top.next[1];
    const uint32_t a = top.after[0], b = top.after[1], c = top.after[2], d = top.after[3];
    LaneMask open = 0;
    OSGRAYTRACE_SIMD_OR(open)
    for (int i = 0; i < kLanes; ++i)
    {
        takeNode(top.root[i], first, second, i, u, at, pmf);
        const uint32_t isFirst = maskOf(at[i] == first);
        const float share = select(isFirst, top.below[0][i], top.below[1][i]);
        open |= bitOfLane(takeNode(share, (a & isFirst) | (c & ~isFirst),
                                   (b & isFirst) | (d & ~isFirst), i, u, at, pmf),
                          i);
    }
    return open;
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
    const LightNode* const nodes = _arrays.nodes.data();
    const auto shares = _areasOnly ? setSharesOfAreas : setShares;
    TopShares top;
    shares(nodes, p, normal, top.root);
    for (std::size_t k = 0; k < 2; ++k)
    {
        top.next[k] = nodes[k].next;
        const bool isLeaf = (top.next[k] & LightPairs::kLeaf) != 0;
        const LightNode* const below = nodes + (isLeaf ? 0 : 2 * std::size_t(top.next[k]));
        top.after[2 * k] = below[0].next;
        top.after[2 * k + 1] = below[1].next;
        if (isLeaf)
            top.below[k] = top.root; // no lane goes on from there
        else
            shares(below, p, normal, top.below[k]);
    }
    LaneMask open = descendTop(top, u, emitters, pmf);
    const auto step = _areasOnly ? descendAreas : descend;
    while (open != 0)
        open = step(nodes, p, normal, u, emitters, pmf);
    for (int i = 0; i < kLanes; ++i)
        emitters[i] &= ~LightPairs::kLeaf;
}

} // namespace osgRayTrace::engine
