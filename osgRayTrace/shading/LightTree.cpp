// LightTree.cpp - nodes of a light tree, choices and their probabilities. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTree.h"

#include <algorithm>
#include <cstring>

namespace osgRayTrace::engine
{

LightTree::LightTree(std::vector<LightEmitter> emitters) : _emitters(std::move(emitters))
{
    OSGRAYTRACE_ASSERT(_emitters.size() >= 2);
    std::vector<LightBounds> bounds;
    bounds.reserve(_emitters.size());
    for (const LightEmitter& emitter : _emitters)
        bounds.push_back(boundsOf(emitter));
    _pairs = std::make_shared<const LightPairs>(lightPairs(bounds));
    setNodes();
    _spreadAtBuild = _spread;
}

LightTree::LightTree(const LightTree& shape, std::vector<LightEmitter> emitters)
    : _pairs(shape._pairs), _emitters(std::move(emitters)), _spreadAtBuild(shape._spreadAtBuild)
{
    OSGRAYTRACE_ASSERT(_emitters.size() == shape.size());
    setNodes();
}

/// Puts the emitters in the order of the leaves, and joins their bounds from the leaves up: the
/// numbers of pairs grow downwards.
void LightTree::setNodes()
{
    const std::vector<uint32_t>& children = _pairs->children;
    std::vector<LightEmitter> ordered(_emitters.size());
    _numbers.resize(_emitters.size());
    for (uint32_t number = 0; number < _emitters.size(); ++number)
    {
        ordered[number] = _emitters[_pairs->order[number]];
        _numbers[_pairs->order[number]] = number;
    }
    _emitters = std::move(ordered);

    _nodes.resize(children.size());
    _parents.assign(children.size() / 2, kInvalid);
    _leafNodes.resize(_emitters.size());
    std::vector<LightBounds> pairs(children.size() / 2);
    for (std::size_t pair = pairs.size(); pair-- > 0;)
    {
        LightBounds both[2];
        for (std::size_t side = 0; side < 2; ++side)
        {
            const auto node = static_cast<uint32_t>(2 * pair + side);
            const uint32_t next = children[node];
            const bool leaf = next & LightPairs::kLeaf;
            const uint32_t number = next & ~LightPairs::kLeaf;
            both[side] = leaf ? boundsOf(_emitters[number]) : pairs[number];
            (leaf ? _leafNodes : _parents)[number] = node;
            _nodes[node] = nodeOf(both[side], next);
            _spread += static_cast<double>(both[side].intensity) * _nodes[node].radius;
        }
        pairs[pair] = joined(both[0], both[1]);
    }
}

LightTree::Choice LightTree::choose(Vec3 p, Vec3 normal, float u) const
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

bool LightTree::holds(const std::vector<LightEmitter>& emitters) const
{
    if (emitters.size() != _emitters.size()) return false;
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (std::memcmp(&emitters[i], &_emitters[_numbers[i]], sizeof(LightEmitter)) != 0)
            return false;
    return true;
}

} // namespace osgRayTrace::engine
