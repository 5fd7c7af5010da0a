// LightSubtree.cpp - joins the bounds of sixteen pairs of nodes at once. Layer: shading.
// SPDX-License-Identifier: MIT
//
// A pair waits for those below it. Pairs of equal height, the largest number of pairs on a way down
// to a leaf, do not wait for each other, and take turns from the least height on. The bounds are
// columns of floats: what sixteen turns join is side by side, and much of what they read.
#include "osgRayTrace/shading/LightSubtree.h"

#include "osgRayTrace/shading/LightNodes.h"
#include "osgRayTrace/shading/LightTree.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kColumns = 16; ///< the floats of PlainBounds

constexpr uint32_t roundedUp(uint32_t count)
{
    return (count + kLanes - 1) / kLanes * kLanes;
}

/// Bounds of all leaves and turns of a subtree.
class Columns
{
public:
    explicit Columns(const LightSubtree& subtree)
        : _stride(roundedUp(subtree.pairs + 1) + subtree.turns.size()),
          _floats(new float[kColumns * _stride])
    {
    }

    float* data() { return _floats.get(); }
    std::size_t stride() const { return _stride; }

private:
    std::size_t _stride;
    std::unique_ptr<float[]> _floats;
};

/// Returns bounds. at: the first column's float.
OSGRAYTRACE_INLINE PlainBounds boundsAt(const float* at, std::size_t stride)
{
    return {{at[0], at[stride], at[2 * stride]},
            {at[3 * stride], at[4 * stride], at[5 * stride]},
            {at[6 * stride], at[7 * stride], at[8 * stride]},
            at[9 * stride],
            at[10 * stride],
            at[11 * stride],
            {at[12 * stride], at[13 * stride], at[14 * stride]},
            at[15 * stride]};
}

OSGRAYTRACE_INLINE void setBounds(float* at, std::size_t stride, const PlainBounds& b)
{
    at[0] = b.low.x;
    at[stride] = b.low.y;
    at[2 * stride] = b.low.z;
    at[3 * stride] = b.high.x;
    at[4 * stride] = b.high.y;
    at[5 * stride] = b.high.z;
    at[6 * stride] = b.axis.x;
    at[7 * stride] = b.axis.y;
    at[8 * stride] = b.axis.z;
    at[9 * stride] = b.cosCone;
    at[10 * stride] = b.cosEmission;
    at[11 * stride] = b.intensity;
    at[12 * stride] = b.falloff.x;
    at[13 * stride] = b.falloff.y;
    at[14 * stride] = b.falloff.z;
    at[15 * stride] = b.range;
}

/// The nodes of sixteen pairs, but for what is below.
struct NodeLanes
{
    Vec3Lanes centre, axis, falloff;
    FloatLanes radius, cosCone, cosEmission, intensity, reach;
    UintLanes extents;

    /// Sets a lane. Returns intensity times radius.
    OSGRAYTRACE_INLINE float set(int i, const PlainBounds& b)
    {
        const PlainVec3 middle = centreOf(b);
        const float around = radiusAround(middle, b);
        setLane(centre, i, middle);
        radius[i] = around;
        setLane(axis, i, b.axis);
        cosCone[i] = b.cosCone;
        extents[i] = packedExtents(b, around);
        cosEmission[i] = b.cosEmission;
        intensity[i] = b.intensity;
        setLane(falloff, i, b.falloff);
        reach[i] = (b.range + around) * kReachSlack;
        return std::fabs(b.intensity) * around;
    }

    OSGRAYTRACE_INLINE LightNode node(int i, uint32_t next) const
    {
        return {{centre.x[i], centre.y[i], centre.z[i]},
                radius[i],
                {axis.x[i], axis.y[i], axis.z[i]},
                cosCone[i],
                extents[i],
                intensity[i],
                next,
                cosEmission[i],
                {falloff.x[i], falloff.y[i], falloff.z[i]},
                reach[i]};
    }
};

/// Sets the bounds of sixteen parallelograms or triangles.
OSGRAYTRACE_KERNEL
void setAreas(const LightEmitter* emitters, const UintLanes& numbers, float* to, std::size_t stride)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        setBounds(to + i, stride, areaBounds(emitters[numbers[i]]));
}

OSGRAYTRACE_INLINE float joinLane(const float* columns, std::size_t stride, uint32_t first,
                                  uint32_t second, int i, float* to, NodeLanes& a, NodeLanes& b)
{
    const PlainBounds boundsA = boundsAt(columns + first, stride);
    const PlainBounds boundsB = boundsAt(columns + second, stride);
    setBounds(to + i, stride, joinedBounds(boundsA, boundsB));
    return a.set(i, boundsA) + b.set(i, boundsB);
}

/// Joins the bounds of sixteen pairs, and sets their nodes. spread: is added to.
OSGRAYTRACE_KERNEL
void joinTurns(const LightTurn* turns, float* columns, std::size_t stride, float* to,
               const uint32_t* children, LightNode* nodes, FloatLanes& spread)
{
    UintLanes first, second;
    UintLanes counts;
    for (int i = 0; i < kLanes; ++i)
    {
        first[i] = turns[i].first;
        second[i] = turns[i].second;
        counts[i] = maskOf(turns[i].counts != 0);
    }
    NodeLanes a, b;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float joined = joinLane(columns, stride, first[i], second[i], i, to, a, b);
        spread[i] += select(counts[i], joined, 0.0f);
    }
    for (int i = 0; i < kLanes; ++i)
    {
        const std::size_t node = 2 * std::size_t(turns[i].pair);
        nodes[node] = a.node(i, children[node]);
        nodes[node + 1] = b.node(i, children[node + 1]);
    }
}

/// Sets the bounds of the leaves.
void setLeaves(const LightEmitter* emitters, uint32_t leaves, Columns& columns)
{
    for (uint32_t k = 0; k < leaves; k += kLanes)
    {
        UintLanes numbers; // the last ones repeat the last leaf
        for (uint32_t i = 0; i < kLanes; ++i)
            numbers[static_cast<int>(i)] = std::min(k + i, leaves - 1);
        setAreas(emitters, numbers, columns.data() + k, columns.stride());
    }
    for (uint32_t k = 0; k < leaves; ++k)
        if (emitters[k].isPoint() || emitters[k].isMesh())
            setBounds(columns.data() + k, columns.stride(), plainOf(boundsOf(emitters[k])));
}

} // namespace

void LightSubtree::setTurns(const uint32_t* children)
{
    OSGRAYTRACE_ASSERT(pairs > 0 && pairs <= kMostPairs);
    std::vector<uint16_t> heights(pairs);
    std::vector<std::vector<uint16_t>> levels; // pairs of equal height
    for (uint32_t k = pairs; k-- > 0;)
    {
        for (const uint32_t node : {2 * (pair + k), 2 * (pair + k) + 1})
            if (!(children[node] & LightPairs::kLeaf))
                heights[k] = std::max<uint16_t>(heights[k], heights[children[node] - pair] + 1);
        if (levels.size() <= heights[k]) levels.resize(heights[k] + 1u);
        levels[heights[k]].push_back(static_cast<uint16_t>(k));
    }
    turns.clear();
    std::vector<uint16_t> numbers(pairs); // of the bounds of pairs
    const auto numberOf = [&](uint32_t child)
    {
        return child & LightPairs::kLeaf
                   ? static_cast<uint16_t>((child & ~LightPairs::kLeaf) - leaf)
                   : numbers[child - pair];
    };
    for (const std::vector<uint16_t>& level : levels)
    {
        for (auto k = level.rbegin(); k != level.rend(); ++k) // ascending, as the leaves are
        {
            const uint32_t node = 2 * (pair + *k);
            numbers[*k] = static_cast<uint16_t>(roundedUp(pairs + 1) + turns.size());
            turns.push_back({*k, numberOf(children[node]), numberOf(children[node + 1]), 1});
        }
        LightTurn repeated = turns.back();
        repeated.counts = 0;
        turns.resize(roundedUp(static_cast<uint32_t>(turns.size())), repeated);
    }
    OSGRAYTRACE_ASSERT(roundedUp(pairs + 1) + turns.size() <=
                       0x10000); // numbers are words of 16 bits
}

SubtreeBounds setNodes(const LightSubtree& subtree, const LightEmitter* emitters,
                       const uint32_t* children, LightNode* nodes)
{
    Columns columns(subtree);
    setLeaves(emitters + subtree.leaf, subtree.pairs + 1, columns);
    FloatLanes spread{};
    const std::size_t node = 2 * std::size_t(subtree.pair);
    float* to = columns.data() + roundedUp(subtree.pairs + 1);
    for (std::size_t k = 0; k < subtree.turns.size(); k += kLanes, to += kLanes)
        joinTurns(&subtree.turns[k], columns.data(), columns.stride(), to, children + node,
                  nodes + node, spread);
    SubtreeBounds all{boundsOf(boundsAt(to - kLanes, columns.stride())), 0.0};
    for (const float sum : spread.v)
        all.spread += static_cast<double>(sum);
    return all;
}

} // namespace osgRayTrace::engine
