// LightTreeLanes.cpp - sixteen points descend a light tree at once. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTree.h"

#include "osgRayTrace/base/RecordLanes.h"
#include "osgRayTrace/shading/LightImportance.h"

namespace osgRayTrace::engine
{

namespace
{

/// Returns all bits if a lane has not come to an emitter yet: kLeaf is the sign.
OSGRAYTRACE_INLINE uint32_t isOpen(uint32_t at)
{
    return ~static_cast<uint32_t>(static_cast<int32_t>(at) >> 31);
}

/// Takes lane i from a pair to one of its nodes, if it has not come to an emitter yet: to the first
/// with the probability share. first, second: what is below the nodes. Returns all bits if the lane
/// goes on.
OSGRAYTRACE_INLINE uint32_t takeNode(float share, uint32_t first, uint32_t second, int i,
                                     FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    const uint32_t open = isOpen(at[i]);
    const uint32_t isFirst = isLess(u[i], share);
    const float own = select(isFirst, share, 1.0f - share);
    const float rescaled = (u[i] - select(isFirst, 0.0f, share)) / own;
    const float below = atMost(rescaled, kOneMinusEpsilon);
    const uint32_t next = (first & isFirst) | (second & ~isFirst);
    u[i] = select(open, below, u[i]);
    pmf[i] = select(open, pmf[i] * own, pmf[i]);
    at[i] = (next & open) | (at[i] & ~open);
    return isOpen(at[i]);
}

/// Sets the probabilities of the first node of one pair. All lanes read the same nodes:
/// unlike in step(), which spends half of its time on that, nothing is read lane by lane.
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

/// The nodes that lanes have come to, in columns of words.
struct NodeLanes
{
    FloatLanes words[16];
};

/// Returns the node of lane i. Words that areas do not have are left out.
template <NodeLights kLights> OSGRAYTRACE_INLINE LightNode nodeOf(const NodeLanes& lanes, int i)
{
    const FloatLanes* const w = lanes.words;
    constexpr bool kAny = kLights == NodeLights::Any;
    LightNode node; // an initializer list of zeros would be a call, and the loop no vector code
    node.centre[0] = w[0][i];
    node.centre[1] = w[1][i];
    node.centre[2] = w[2][i];
    node.radius = w[3][i];
    node.axis[0] = w[4][i];
    node.axis[1] = w[5][i];
    node.axis[2] = w[6][i];
    node.cosCone = w[7][i];
    node.extents = wordOf(w[8], i);
    node.intensity = w[9][i];
    node.next = wordOf(w[10], i);
    node.cosEmission = w[11][i];
    node.falloff[0] = kAny ? w[12][i] : 0.0f;
    node.falloff[1] = kAny ? w[13][i] : 0.0f;
    node.falloff[2] = kAny ? w[14][i] : 0.0f;
    node.reach = kAny ? w[15][i] : 0.0f;
    return node;
}

/// Reads pairs of nodes. at: the lanes' first nodes.
template <NodeLights kLights>
OSGRAYTRACE_INLINE void readPairs(const LightNode* nodes, const UintLanes& at, NodeLanes& first,
                                  NodeLanes& second)
{
    const float* const words = nodes->centre;
    readWords(words, at, first.words);
    readWords(words + kRecordWords, at, second.words);
    readWords(words + 4, at, first.words + 4);
    readWords(words + kRecordWords + 4, at, second.words + 4);
    readWords(words + 8, at, first.words + 8);
    readWords(words + kRecordWords + 8, at, second.words + 8);
    if constexpr (kLights == NodeLights::Areas) return;
    readWords(words + 12, at, first.words + 12);
    readWords(words + kRecordWords + 12, at, second.words + 12);
}

/// Takes each lane from its pair to one of the nodes. kRead: nodes are read four words at a time,
/// not gathered. Returns the lanes that go on.
template <NodeLights kLights, bool kRead>
OSGRAYTRACE_INLINE LaneMask step(const LightNode* nodes, const Vec3Lanes& p,
                                 const Vec3Lanes& normal, FloatLanes& u, UintLanes& at,
                                 FloatLanes& pmf)
{
    LaneMask open = 0;
    if constexpr (kRead)
    {
        UintLanes pairs;
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            pairs[i] = 2 * (at[i] & isOpen(at[i]));
        NodeLanes firsts, seconds;
        readPairs<kLights>(nodes, pairs, firsts, seconds);
        OSGRAYTRACE_SIMD_OR(open)
        for (int i = 0; i < kLanes; ++i)
        {
            const LightNode first = nodeOf<kLights>(firsts, i);
            const LightNode second = nodeOf<kLights>(seconds, i);
            const float share =
                shareOfFirst<kLights>(first, second, plainOf(p, i), plainOf(normal, i));
            open |= bitOfLane(takeNode(share, first.next, second.next, i, u, at, pmf), i);
        }
        return open;
    }
    OSGRAYTRACE_SIMD_OR(open)
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t node = 2 * (at[i] & isOpen(at[i]));
        const LightNode& first = nodes[node];
        const LightNode& second = nodes[node + 1];
        const float share = shareOfFirst<kLights>(first, second, plainOf(p, i), plainOf(normal, i));
        open |= bitOfLane(takeNode(share, first.next, second.next, i, u, at, pmf), i);
    }
    return open;
}

using Step = LaneMask (*)(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal,
                          FloatLanes& u, UintLanes& at, FloatLanes& pmf);

OSGRAYTRACE_KERNEL
LaneMask gatherStep(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal,
                    FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Any, false>(nodes, p, normal, u, at, pmf);
}

OSGRAYTRACE_KERNEL
LaneMask gatherAreasStep(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal,
                         FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Areas, false>(nodes, p, normal, u, at, pmf);
}

OSGRAYTRACE_KERNEL
LaneMask readStep(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal,
                  FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Any, true>(nodes, p, normal, u, at, pmf);
}

OSGRAYTRACE_KERNEL
LaneMask readAreasStep(const LightNode* nodes, const Vec3Lanes& p, const Vec3Lanes& normal,
                       FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Areas, true>(nodes, p, normal, u, at, pmf);
}

/// Returns the step of trees with or without point lights.
Step stepFor(bool areasOnly)
{
    if (readsRecordsFast()) return areasOnly ? readAreasStep : readStep;
    return areasOnly ? gatherAreasStep : gatherStep;
}

} // namespace

void LightTree::chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, Pick* picks,
                            std::size_t count) const
{
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
    for (std::size_t k = 0; k < count; ++k)
    {
        Pick& pick = picks[k];
        for (int i = 0; i < kLanes; ++i)
        {
            pick.emitters[i] = 0;
            pick.pmf[i] = 1.0f;
        }
        pick.open = descendTop(top, pick.u, pick.emitters, pick.pmf);
    }
    // Picks take steps by turns: a processor begins the step of one while results of another one
    // are still to come.
    const Step step = stepFor(_areasOnly);
    for (bool goesOn = true; goesOn;)
    {
        goesOn = false;
        for (std::size_t k = 0; k < count; ++k)
        {
            Pick& pick = picks[k];
            if (pick.open == 0) continue;
            pick.open = step(nodes, p, normal, pick.u, pick.emitters, pick.pmf);
            goesOn |= pick.open != 0;
        }
    }
    for (std::size_t k = 0; k < count; ++k)
        for (int i = 0; i < kLanes; ++i)
            picks[k].emitters[i] &= ~LightPairs::kLeaf;
}

} // namespace osgRayTrace::engine
