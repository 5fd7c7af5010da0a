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

/// Reads the nodes of lanes.
template <NodeLights kLights>
OSGRAYTRACE_INLINE void readNodes(const LightNode* nodes, const UintLanes& at, NodeLanes& lanes)
{
    const float* const words = nodes->centre;
    readWords(words, at, lanes.words);
    readWords(words + 4, at, lanes.words + 4);
    readWords(words + 8, at, lanes.words + 8);
    if constexpr (kLights == NodeLights::Areas) return;
    readWords(words + 12, at, lanes.words + 12);
}

/// The nodes of each lane's step, by place.
struct StepLanes
{
    UintLanes nodes[4];
    UintLanes has1, has3; ///< masks: whether there are nodes at places 1 and 3
    FloatLanes importances[4];
    UintLanes next[4]; ///< what is below the nodes
};

/// Sets what is at places 2 side and 2 side + 1 of lane i. child: what is below the node.
OSGRAYTRACE_INLINE uint32_t setPlaces(uint32_t node, uint32_t child, int i, UintLanes& first,
                                      UintLanes& second)
{
    const uint32_t isInner = isOpen(child);
    const uint32_t below = select(isInner, 2 * child, node);
    first[i] = below;
    second[i] = below + (isInner & 1u);
    return isInner;
}

/// Finds the nodes of the lanes' steps. children: see LightPairs.
OSGRAYTRACE_INLINE void findNodes(const uint32_t* children, const UintLanes& at, StepLanes& step)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t node = 2 * (at[i] & isOpen(at[i]));
        step.has1[i] = setPlaces(node, children[node], i, step.nodes[0], step.nodes[1]);
        step.has3[i] = setPlaces(node + 1, children[node + 1], i, step.nodes[2], step.nodes[3]);
    }
}

/// Sets importances of the nodes of one place, and what is below them. kRead: nodes are read four
/// words at a time, not gathered.
template <NodeLights kLights, bool kRead>
OSGRAYTRACE_INLINE void weighPlace(const LightNode* nodes, const UintLanes& at, const Vec3Lanes& p,
                                   const Vec3Lanes& normal, FloatLanes& importances,
                                   UintLanes& next)
{
    if constexpr (kRead)
    {
        NodeLanes lanes;
        readNodes<kLights>(nodes, at, lanes);
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            const LightNode node = nodeOf<kLights>(lanes, i);
            importances[i] = importance<kLights>(node, plainOf(p, i), plainOf(normal, i));
            next[i] = node.next;
        }
        return;
    }
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const LightNode& node = nodes[at[i]];
        importances[i] = importance<kLights>(node, plainOf(p, i), plainOf(normal, i));
        next[i] = node.next;
    }
}

/// Returns the weights of the places of lane i. Made in the loop itself, they would have a place in
/// memory for each turn, and the loop no vector code.
OSGRAYTRACE_INLINE StepWeights weightsOf(const FloatLanes* importances, uint32_t has1,
                                         uint32_t has3, int i)
{
    return stepWeights({importances[0][i], importances[1][i], importances[2][i], importances[3][i]},
                       has1, has3);
}

/// Takes lane i to a place of its step, if it has not come to an emitter yet. Returns all bits if
/// the lane goes on.
OSGRAYTRACE_INLINE uint32_t takeStep(StepWeights weights, uint32_t next0, uint32_t next1,
                                     uint32_t next2, uint32_t next3, int i, FloatLanes& u,
                                     UintLanes& at, FloatLanes& pmf)
{
    const uint32_t open = isOpen(at[i]);
    const StepChoice choice = chooseStep(weights, u[i]);
    const uint32_t is3 = ~(choice.is0 | choice.is1 | choice.is2);
    const uint32_t next =
        (next0 & choice.is0) | (next1 & choice.is1) | (next2 & choice.is2) | (next3 & is3);
    u[i] = select(open, choice.u, u[i]);
    pmf[i] = select(open, pmf[i] * choice.probability, pmf[i]);
    at[i] = (next & open) | (at[i] & ~open);
    return isOpen(at[i]);
}

/// Takes each lane one step down. Returns the lanes that go on.
template <NodeLights kLights, bool kRead>
OSGRAYTRACE_INLINE LaneMask step(const LightNode* nodes, const uint32_t* children,
                                 const Vec3Lanes& p, const Vec3Lanes& normal, FloatLanes& u,
                                 UintLanes& at, FloatLanes& pmf)
{
    StepLanes s;
    findNodes(children, at, s);
    for (int k = 0; k < 4; ++k)
        weighPlace<kLights, kRead>(nodes, s.nodes[k], p, normal, s.importances[k], s.next[k]);
    LaneMask open = 0;
    OSGRAYTRACE_SIMD_OR(open)
    for (int i = 0; i < kLanes; ++i)
    {
        open |= bitOfLane(takeStep(weightsOf(s.importances, s.has1[i], s.has3[i], i), s.next[0][i],
                                   s.next[1][i], s.next[2][i], s.next[3][i], i, u, at, pmf),
                          i);
    }
    return open;
}

using LaneStep = LaneMask (*)(const LightNode* nodes, const uint32_t* children, const Vec3Lanes& p,
                              const Vec3Lanes& normal, FloatLanes& u, UintLanes& at,
                              FloatLanes& pmf);

OSGRAYTRACE_KERNEL
LaneMask gatherStep(const LightNode* nodes, const uint32_t* children, const Vec3Lanes& p,
                    const Vec3Lanes& normal, FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Any, false>(nodes, children, p, normal, u, at, pmf);
}

OSGRAYTRACE_KERNEL
LaneMask gatherAreasStep(const LightNode* nodes, const uint32_t* children, const Vec3Lanes& p,
                         const Vec3Lanes& normal, FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Areas, false>(nodes, children, p, normal, u, at, pmf);
}

OSGRAYTRACE_KERNEL
LaneMask readStep(const LightNode* nodes, const uint32_t* children, const Vec3Lanes& p,
                  const Vec3Lanes& normal, FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Any, true>(nodes, children, p, normal, u, at, pmf);
}

OSGRAYTRACE_KERNEL
LaneMask readAreasStep(const LightNode* nodes, const uint32_t* children, const Vec3Lanes& p,
                       const Vec3Lanes& normal, FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    return step<NodeLights::Areas, true>(nodes, children, p, normal, u, at, pmf);
}

/// Returns the step of trees with or without point lights.
LaneStep stepFor(bool areasOnly)
{
    if (readsRecordsFast()) return areasOnly ? readAreasStep : readStep;
    return areasOnly ? gatherAreasStep : gatherStep;
}

/// The step from the root, which all lanes and picks share.
struct RootStep
{
    FloatLanes importances[4];
    uint32_t next[4];
    uint32_t has1, has3;
};

/// Sets importances of one node. All lanes read the same node: unlike in step(), which spends half
/// of its time on that, nothing is read lane by lane.
OSGRAYTRACE_KERNEL
void weighNode(const LightNode& read, const Vec3Lanes& p, const Vec3Lanes& normal,
               FloatLanes& importances)
{
    const LightNode node = read;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        importances[i] = importance<NodeLights::Any>(node, plainOf(p, i), plainOf(normal, i));
}

/// Does what weighNode does, in a tree without point lights.
OSGRAYTRACE_KERNEL
void weighNodeOfAreas(const LightNode& read, const Vec3Lanes& p, const Vec3Lanes& normal,
                      FloatLanes& importances)
{
    const LightNode node = read;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        importances[i] = importance<NodeLights::Areas>(node, plainOf(p, i), plainOf(normal, i));
}

/// Begins a pick: takes its lanes one step down from the root. Returns the lanes that go on.
OSGRAYTRACE_KERNEL
LaneMask takeRootStep(const RootStep& root, FloatLanes& u, UintLanes& at, FloatLanes& pmf)
{
    const uint32_t next0 = root.next[0], next1 = root.next[1], next2 = root.next[2],
                   next3 = root.next[3], has1 = root.has1, has3 = root.has3;
    LaneMask open = 0;
    OSGRAYTRACE_SIMD_OR(open)
    for (int i = 0; i < kLanes; ++i)
    {
        at[i] = 0;
        pmf[i] = 1.0f;
        open |= bitOfLane(takeStep(weightsOf(root.importances, has1, has3, i), next0, next1, next2,
                                   next3, i, u, at, pmf),
                          i);
    }
    return open;
}

} // namespace

void LightTree::chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, Pick* picks,
                            std::size_t count) const
{
    const LightNode* const nodes = _arrays.nodes.data();
    const uint32_t* const children = _pairs->children.data();
    RootStep root;
    for (uint32_t place = 0; place < 4; ++place)
    {
        const uint32_t child = children[place / 2];
        const bool isLeaf = (child & LightPairs::kLeaf) != 0;
        const uint32_t node = isLeaf ? place / 2 : 2 * child + place % 2;
        root.next[place] = children[node];
        (_areasOnly ? weighNodeOfAreas : weighNode)(nodes[node], p, normal,
                                                    root.importances[place]);
    }
    root.has1 = isOpen(children[0]);
    root.has3 = isOpen(children[1]);
    for (std::size_t k = 0; k < count; ++k)
        picks[k].open = takeRootStep(root, picks[k].u, picks[k].emitters, picks[k].pmf);
    // Picks take steps by turns: a processor begins the step of one while results of another one
    // are still to come.
    const LaneStep step = stepFor(_areasOnly);
    for (bool goesOn = true; goesOn;)
    {
        goesOn = false;
        for (std::size_t k = 0; k < count; ++k)
        {
            Pick& pick = picks[k];
            if (pick.open == 0) continue;
            pick.open = step(nodes, children, p, normal, pick.u, pick.emitters, pick.pmf);
            goesOn |= pick.open != 0;
        }
    }
    for (std::size_t k = 0; k < count; ++k)
        for (int i = 0; i < kLanes; ++i)
            picks[k].emitters[i] &= ~LightPairs::kLeaf;
}

} // namespace osgRayTrace::engine
