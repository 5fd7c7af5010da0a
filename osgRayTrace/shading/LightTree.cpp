// LightTree.cpp - nodes of a light tree, choices and their probabilities. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTree.h"

#include "osgRayTrace/shading/LightImportance.h"

#include <algorithm>

namespace osgRayTrace::engine
{

LightArrays SpareLightArrays::take(std::size_t emitters)
{
    LightArrays arrays;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        arrays = std::move(_arrays);
    }
    if (arrays.emitters.size() == emitters) return arrays;
    return {LightEmitters(emitters), UnclearedArray<LightNode>(2 * (emitters - 1))};
}

void SpareLightArrays::give(LightArrays&& arrays)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    std::swap(_arrays, arrays);
}

bool SpareLightArrays::isEmpty()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _arrays.emitters.size() == 0;
}

LightTree::LightTree(const LightEmitters& emitters, const Workers* workers)
    : _spare(std::make_shared<SpareLightArrays>())
{
    OSGRAYTRACE_ASSERT(emitters.size() >= 2);
    _pairs = std::make_shared<const LightPairs>(lightPairs(emitters, workers));
    const auto listed = [&](const uint32_t* indices, std::size_t count, LightEmitter* to)
    {
        for (std::size_t k = 0; k < count; ++k)
            to[k] = emitters[indices[k]];
    };
    setNodes(listed, workers);
    _spreadAtBuild = _spread;
}

LightTree::LightTree(const LightTree& shape, const EmitterSource& source, const Workers* workers)
    : _pairs(shape._pairs), _spare(shape._spare), _spreadAtBuild(shape._spreadAtBuild)
{
    setNodes(source, workers);
}

LightTree::~LightTree()
{
    _spare->give(std::move(_arrays));
}

std::shared_ptr<const LightTree> LightTree::after(const LightTree* previous,
                                                  const EmitterSource& source, std::size_t count,
                                                  const Workers* workers)
{
    constexpr double kMostSpread = 1.5; // times the spread for which the shape was made
    if (previous && previous->size() == count)
    {
        auto refitted = std::make_shared<const LightTree>(*previous, source, workers);
        if (refitted->spread() <= kMostSpread * refitted->spreadAtBuild()) return refitted;
    }
    return std::make_shared<const LightTree>(allEmitters(source, count, workers), workers);
}

/// Puts the emitters in the order of the leaves, and joins their bounds from the leaves up. The
/// subtrees do not depend on each other, and their sums are added in their order.
void LightTree::setNodes(const EmitterSource& source, const Workers* workers)
{
    _arrays = _spare->take(_pairs->order.size());
    const std::vector<LightSubtree>& subtrees = _pairs->subtrees;
    std::vector<Joined> parts(subtrees.size());
    forEachPart(workers, subtrees.size(), 1,
                [&](std::size_t k, std::size_t) { parts[k] = setSubtree(subtrees[k], source); });
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
        const Joined top = setTop(pair, source, joinedPairs);
        joinedPairs[pair] = top;
        if (pair == 0) _bounds = top.bounds;
        _spread += top.spread;
        _areasOnly &= !top.points;
        _hasRectangles |= top.rectangles;
    }
}

LightTree::Joined LightTree::setSubtree(const LightSubtree& subtree, const EmitterSource& source)
{
    LightEmitter* const emitters = _arrays.emitters.data();
    source(&_pairs->order[subtree.leaf], subtree.pairs + 1, emitters + subtree.leaf);
    Joined all;
    for (uint32_t k = 0; k <= subtree.pairs; ++k)
        all.addLeaf(emitters[subtree.leaf + k]);
    const SubtreeBounds joined =
        engine::setNodes(subtree, emitters, _pairs->children.data(), _arrays.nodes.data());
    all.bounds = joined.bounds;
    all.spread = joined.spread;
    return all;
}

LightTree::Joined LightTree::setTop(uint32_t pair, const EmitterSource& source,
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
            source(&_pairs->order[number], 1, _arrays.emitters.data() + number);
            all.addLeaf(_arrays.emitters[number]);
            both[side] = boundsOf(_arrays.emitters[number]);
        }
        else
            both[side] = below.at(next).bounds;
        _arrays.nodes[node] = nodeOf(both[side], next);
        all.spread += static_cast<double>(both[side].intensity) * _arrays.nodes[node].radius;
    }
    all.bounds = joined(both[0], both[1]);
    return all;
}

/// Returns the step from a pair.
LightTree::Step LightTree::stepFrom(uint32_t pair, Vec3 p, Vec3 normal) const
{
    Step step;
    float importances[4] = {};
    uint32_t has[4] = {};
    for (uint32_t side = 0; side < 2; ++side)
    {
        const uint32_t node = 2 * pair + side, below = _pairs->children[node];
        const bool isLeaf = (below & LightPairs::kLeaf) != 0;
        for (uint32_t k = 0; k < (isLeaf ? 1 : 2); ++k)
        {
            const uint32_t place = 2 * side + k;
            step.nodes[place] = isLeaf ? node : 2 * below + k;
            has[place] = ~0u;
            importances[place] =
                importance(_arrays.nodes[step.nodes[place]], plainOf(p), plainOf(normal));
        }
    }
    step.weights = stepWeights({importances[0], importances[1], importances[2], importances[3]},
                               has[1], has[3]);
    return step;
}

LightTree::Choice LightTree::choose(Vec3 p, Vec3 normal, float& u) const
{
    Choice choice{0, 1.0f};
    while (!(choice.emitter & LightPairs::kLeaf))
    {
        const Step step = stepFrom(choice.emitter, p, normal);
        const StepChoice chosen = chooseStep(step.weights, u);
        u = chosen.u;
        choice.pmf *= chosen.probability;
        const int place = chosen.is0 ? 0 : chosen.is1 ? 1 : chosen.is2 ? 2 : 3;
        choice.emitter = _pairs->children[step.nodes[place]];
    }
    choice.emitter &= ~LightPairs::kLeaf;
    return choice;
}

float LightTree::pmf(Vec3 p, Vec3 normal, uint32_t emitter) const
{
    uint32_t node = _pairs->leafNodes[emitter];
    uint32_t levels = 0;
    for (uint32_t above = node; above != kInvalid; above = _pairs->parents[above / 2])
        ++levels;
    float pmf = 1.0f;
    // Steps begin at the root, so that the last one ends one level below its pair if the number of
    // levels is odd.
    for (bool isShort = levels % 2; node != kInvalid; isShort = false)
    {
        const uint32_t child = isShort ? node : _pairs->parents[node / 2];
        const StepWeights weights = stepFrom(child / 2, p, normal).weights;
        const float places[4] = {weights.w0, weights.w1, weights.w2, weights.w3};
        pmf *= places[2 * (child & 1) + (isShort ? 0 : node & 1)] / sumOf(weights);
        node = _pairs->parents[child / 2];
    }
    return pmf;
}

} // namespace osgRayTrace::engine
