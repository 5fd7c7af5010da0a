// LightSubtreeTest.cpp - nodes of light trees that sixteen pairs at once have joined.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/LightTree.h"

#include <cstring>
#include <set>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns triangles, some of no size, parallelograms of one side and of both, and spots.
LightEmitters mixedEmitters(std::size_t count)
{
    Uniform random(5);
    LightEmitters emitters(count);
    for (std::size_t k = 0; k < count; ++k)
    {
        LightEmitter e{};
        const double size = k % 31 == 7 ? 0.0 : 0.1;
        for (int c = 0; c < 3; ++c)
        {
            e.corner[c] = static_cast<float>(random.between(-5, 5));
            e.edgeU[c] = static_cast<float>(random.between(-size, size));
            e.edgeV[c] = static_cast<float>(random.between(-size, size));
            e.radiance[c] = k % 13 == 3 ? 0.0f : static_cast<float>(random.between(0, 2));
        }
        e.area = static_cast<float>(random.between(0.01, 0.1));
        e.primitive = e.light = static_cast<uint32_t>(k);
        const uint32_t flags[] = {kTriangle | kTwoSided, 0, kTwoSided, kPoint};
        e.flags = flags[random() * 4.0f > 3.0f ? k % 4 : 0];
        if (e.isPoint())
        {
            const Vec3 axis = glm::normalize(Vec3(e.edgeU[0], e.edgeU[1], e.edgeU[2]) + 1e-3f);
            for (int c = 0; c < 3; ++c)
                e.edgeU[c] = axis[c];
            const float cutoff = 0.5f, exponent = 3.0f, range = 20.0f;
            e.edgeV[0] = cutoff;
            e.edgeV[1] = exponent;
            std::memcpy(&e.primitive, &range, sizeof range);
        }
        emitters[k] = e;
    }
    return emitters;
}

/// Adds a node and all below it one after the other, from what joined() and nodeOf() return.
LightBounds expectedBelow(const LightPairs& pairs, const LightEmitter* emitters, uint32_t next,
                          std::vector<LightNode>& nodes, double& spread)
{
    if (next & LightPairs::kLeaf) return boundsOf(emitters[next & ~LightPairs::kLeaf]);
    LightBounds both[2];
    for (uint32_t side = 0; side < 2; ++side)
    {
        const uint32_t node = 2 * next + side, below = pairs.children[node];
        both[side] = expectedBelow(pairs, emitters, below, nodes, spread);
        nodes[node] = nodeOf(both[side], below);
        spread += double(both[side].intensity) * nodes[node].radius;
    }
    return joined(both[0], both[1]);
}

/// Returns the largest difference of the words of two nodes.
double difference(const LightNode& a, const LightNode& b)
{
    if (a.next != b.next) return kInfinity;
    double largest = 0.0;
    const auto compare = [&](float x, float y)
    {
        if (x != y) largest = std::max(largest, std::fabs(double(x) - double(y)));
        if (std::isnan(x) || std::isnan(y)) largest = kInfinity;
    };
    for (int c = 0; c < 3; ++c)
    {
        compare(a.centre[c], b.centre[c]);
        compare(a.axis[c], b.axis[c]);
        compare(a.falloff[c], b.falloff[c]);
    }
    compare(a.radius, b.radius);
    compare(a.cosCone, b.cosCone);
    compare(a.cosEmission, b.cosEmission);
    compare(a.intensity, b.intensity);
    compare(a.reach, b.reach);
    for (const uint32_t shift : {0u, 10u, 20u}) // a step is 1/1023 of the half diagonal
        compare(static_cast<float>((a.extents >> shift) & 1023u) / 1023.0f,
                static_cast<float>((b.extents >> shift) & 1023u) / 1023.0f);
    return largest;
}

/// Returns the shape in which each pair but the last has a leaf and a pair.
LightPairs chain(uint32_t leaves)
{
    LightPairs pairs;
    pairs.children.reuse(2 * leaves - 2);
    for (uint32_t k = 0; k + 1 < leaves; ++k)
    {
        pairs.children[2 * k] = LightPairs::kLeaf | k;
        pairs.children[2 * k + 1] = k + 2 < leaves ? k + 1 : LightPairs::kLeaf | (k + 1);
    }
    pairs.subtrees.push_back({0, leaves - 1, 0, {}});
    pairs.subtrees[0].setTurns(pairs.children.data());
    return pairs;
}

/// Checks the turns and the nodes of a shape that is one subtree.
void checkShape(const LightPairs& pairs, const LightEmitter* emitters)
{
    REQUIRE(pairs.subtrees.size() == 1);
    const LightSubtree& subtree = pairs.subtrees[0];
    CAPTURE(subtree.pairs);
    const std::vector<LightTurn>& turns = subtree.turns;
    REQUIRE(turns.size() % kLanes == 0);
    const std::size_t firstTurn = (subtree.pairs + kLanes) / kLanes * kLanes;
    std::set<uint16_t> done;
    uint32_t counted = 0;
    for (std::size_t k = 0; k < turns.size(); ++k)
    {
        counted += turns[k].counts;
        done.insert(turns[k].pair);
        for (const std::size_t bounds : {turns[k].first, turns[k].second})
            REQUIRE((bounds <= subtree.pairs ||
                     (bounds >= firstTurn && bounds < firstTurn + k / kLanes * kLanes)));
    }
    CHECK(counted == subtree.pairs);
    CHECK(done.size() == subtree.pairs);

    std::vector<LightNode> nodes(2 * std::size_t(subtree.pairs)), expected(nodes);
    double spread = 0.0;
    const LightBounds bounds = expectedBelow(pairs, emitters, 0, expected, spread);
    const SubtreeBounds found = setNodes(subtree, emitters, pairs.children.data(), nodes.data());
    double largest = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
        largest = std::max(largest, difference(nodes[k], expected[k]));
    // Functions for several processors round products and sums otherwise, some 100 times in turn.
    CHECK(largest < 2e-3);
    CHECK(found.spread == Approx(spread).epsilon(1e-5));
    CHECK(found.bounds.intensity == Approx(bounds.intensity).epsilon(1e-5));
    CHECK(found.bounds.low == bounds.low);
    CHECK(found.bounds.high == bounds.high);
    CHECK(found.bounds.range == bounds.range);
    CHECK(found.bounds.twoSided == bounds.twoSided);
}

} // namespace

TEST_CASE("light tree: nodes of sixteen pairs at once are those of one after the other",
          "[shading]")
{
    for (const std::size_t count : {2, 3, 16, 17, 33, 500, 4096})
    {
        const LightEmitters emitters = mixedEmitters(count);
        const LightPairs pairs = lightPairs(emitters, nullptr);
        LightEmitters ordered(count);
        for (std::size_t k = 0; k < count; ++k)
            ordered[k] = emitters[pairs.order[k]];
        checkShape(pairs, ordered.data());
    }
    const LightEmitters emitters = mixedEmitters(60);
    for (const uint32_t leaves : {2u, 3u, 20u, 60u})
        checkShape(chain(leaves), emitters.data());
}
