// LightSubtree.h - bounds of the nodes of a part of a light tree, sixteen pairs at once. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/LightEmitters.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// A pair of nodes of a subtree, whose bounds are joined in its turn. The bounds that turns join
/// are numbered in the order of turns, after those of the leaves, whose number is rounded up to
/// sixteen.
struct LightTurn
{
    uint16_t pair;          ///< its number among the pairs of the subtree
    uint16_t first, second; ///< the numbers of its nodes' bounds
    uint16_t counts;        ///< 0 if the turn repeats the one before it, else 1
};

/// A pair with all that is below it.
struct LightSubtree
{
    static constexpr uint32_t kMostPairs = 4095;

    uint32_t pair = 0, pairs = 0; ///< the number of the pair, and how many there are
    uint32_t leaf = 0;            ///< the first of pairs + 1 leaves

    /// Sixteen after sixteen turns, of which none needs what another one of them joins.
    std::vector<LightTurn> turns;

    /// Sets the turns. children: LightPairs::children of the whole tree.
    void setTurns(const uint32_t* children);
};

/// What is known of a subtree whose nodes are set.
struct SubtreeBounds
{
    LightBounds bounds;
    double spread = 0.0; ///< sum over its nodes of intensity times radius
};

/// Sets the nodes of a subtree. nodes, emitters, children: those of the whole tree.
SubtreeBounds setNodes(const LightSubtree& subtree, const LightEmitter* emitters,
                       const uint32_t* children, LightNode* nodes);

} // namespace osgRayTrace::engine
