// LightTree.cpp - nodes of a light tree, choices and their probabilities. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTree.h"

#include <algorithm>
#include <cstring>

namespace osgRayTrace::engine
{

LightTree::LightTree(const LightEmitters& emitters, const Workers* workers)
{
    OSGRAYTRACE_ASSERT(emitters.size() >= 2);
    _pairs = std::make_shared<const LightPairs>(lightPairs(emitters, workers));
    setNodes(emitters, workers);
    _spreadAtBuild = _spread;
}

LightTree::LightTree(const LightTree& shape, const LightEmitters& emitters, const Workers* workers)
    : _pairs(shape._pairs), _spreadAtBuild(shape._spreadAtBuild)
{
    OSGRAYTRACE_ASSERT(emitters.size() == shape.size());
    setNodes(emitters, workers);
}

std::shared_ptr<const LightTree> LightTree::after(const std::shared_ptr<const LightTree>& previous,
                                                  const LightEmitters& emitters,
                                                  const Workers* workers)
{
    constexpr double kMostSpread = 1.5; // times the spread for which the shape was made
    if (previous && previous->holds(emitters)) return previous;
    if (previous && previous->size() == emitters.size())
    {
        auto refitted = std::make_shared<const LightTree>(*previous, emitters, workers);
        if (refitted->spread() <= kMostSpread * refitted->spreadAtBuild()) return refitted;
    }
    return std::make_shared<const LightTree>(emitters, workers);
}

/// Puts the emitters in the order of the leaves, and joins their bounds from the leaves up. The
/// subtrees do not depend on each other, and their sums are added in their order.
void LightTree::setNodes(const LightEmitters& emitters, const Workers* workers)
{
    const std::size_t pairs = emitters.size() - 1;
    _emitters = LightEmitters(emitters.size());
    _numbers = UnclearedArray<uint32_t>(emitters.size());
    _nodes = UnclearedArray<LightNode>(2 * pairs);
    _parents = UnclearedArray<uint32_t>(pairs);
    _leafNodes = UnclearedArray<uint32_t>(emitters.size());
    _parents[0] = kInvalid;
    const std::vector<LightPairs::Subtree>& subtrees = _pairs->subtrees;
    std::vector<Joined> parts(subtrees.size());
    forEachPart(workers, subtrees.size(), 1,
                [&](std::size_t k, std::size_t) { parts[k] = setSubtree(subtrees[k], emitters); });
    JoinedPairs joinedPairs;
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
        joinedPairs[subtrees[k].pair] = parts[k];
        if (subtrees[k].pair == 0) _bounds = parts[k].bounds;
        _spread += parts[k].spread;
        _areasOnly &= !parts[k].points;
        _hasRectangles |= parts[k].rectangles;
    }
    for (std::size_t k = _pairs->top.size(); k-- > 0;)
    {
        const uint32_t pair = _pairs->top[k];
        const Joined top = setTop(pair, emitters, joinedPairs);
        joinedPairs[pair] = top;
        if (pair == 0) _bounds = top.bounds;
        _spread += top.spread;
        _areasOnly &= !top.points;
        _hasRectangles |= top.rectangles;
    }
}

void LightTree::setLeaf(uint32_t number, const LightEmitters& emitters)
{
    const uint32_t index = _pairs->order[number];
    _emitters[number] = emitters[index];
    _numbers[index] = number;
}

/// Sets a node, and the way up to it from what is below.
void LightTree::setNode(uint32_t node, const LightBounds& bounds)
{
    const uint32_t next = _pairs->children[node];
    if (next & LightPairs::kLeaf)
        _leafNodes[next & ~LightPairs::kLeaf] = node;
    else
        _parents[next] = node;
    _nodes[node] = nodeOf(bounds, next);
}

LightTree::Joined LightTree::setSubtree(const LightPairs::Subtree& subtree,
                                        const LightEmitters& emitters)
{
    Joined all;
    for (uint32_t k = 0; k <= subtree.pairs; ++k)
    {
        setLeaf(subtree.leaf + k, emitters);
        all.addLeaf(_emitters[subtree.leaf + k]);
    }
    std::vector<LightBounds> pairs(subtree.pairs);
    for (uint32_t k = subtree.pairs; k-- > 0;)
    {
        const uint32_t first = 2 * (subtree.pair + k);
        LightBounds both[2];
        for (uint32_t side = 0; side < 2; ++side)
        {
            const uint32_t next = _pairs->children[first + side];
            both[side] = next & LightPairs::kLeaf ? boundsOf(_emitters[next & ~LightPairs::kLeaf])
                                                  : pairs[next - subtree.pair];
            setNode(first + side, both[side]);
            all.spread += static_cast<double>(both[side].intensity) * _nodes[first + side].radius;
        }
        pairs[k] = joined(both[0], both[1]);
    }
    all.bounds = pairs[0];
    return all;
}

LightTree::Joined LightTree::setTop(uint32_t pair, const LightEmitters& emitters,
                                    const JoinedPairs& below)
{
    LightBounds both[2];
    Joined all;
    for (uint32_t side = 0; side < 2; ++side)
    {
        const uint32_t node = 2 * pair + side, next = _pairs->children[node];
        if (next & LightPairs::kLeaf)
        {
            const uint32_t number = next & ~LightPairs::kLeaf;
            setLeaf(number, emitters);
            all.addLeaf(_emitters[number]);
            both[side] = boundsOf(_emitters[number]);
        }
        else
            both[side] = below.at(next).bounds;
        setNode(node, both[side]);
        all.spread += static_cast<double>(both[side].intensity) * _nodes[node].radius;
    }
    all.bounds = joined(both[0], both[1]);
    return all;
}

LightTree::Choice LightTree::choose(Vec3 p, Vec3 normal, float& u) const
{
    const PlainVec3 point = plainOf(p), n = plainOf(normal);
    Choice choice{0, 1.0f};
    while (!(choice.emitter & LightPairs::kLeaf))
    {
        const LightNode* nodes = &_nodes[2 * std::size_t(choice.emitter)];
        const float share = shareOfFirst(nodes[0], nodes[1], point, n);
        const bool first = u < share;
        const float pmf = first ? share : 1.0f - share;
        u = std::min((first ? u : u - share) / pmf, kOneMinusEpsilon);
        choice.pmf *= pmf;
        choice.emitter = nodes[first ? 0 : 1].next;
    }
    choice.emitter &= ~LightPairs::kLeaf;
    return choice;
}

float LightTree::pmf(Vec3 p, Vec3 normal, uint32_t emitter) const
{
    float pmf = 1.0f;
    for (uint32_t node = _leafNodes[emitter]; node != kInvalid; node = _parents[node / 2])
    {
        const LightNode* nodes = &_nodes[node & ~1u];
        const float share = shareOfFirst(nodes[0], nodes[1], plainOf(p), plainOf(normal));
        pmf *= node & 1u ? 1.0f - share : share;
    }
    return pmf;
}

bool LightTree::holds(const LightEmitters& emitters) const
{
    if (emitters.size() != _emitters.size()) return false;
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (std::memcmp(&emitters[i], &_emitters[_numbers[i]], sizeof(LightEmitter)) != 0)
            return false;
    return true;
}

} // namespace osgRayTrace::engine
