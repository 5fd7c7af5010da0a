// LightTreeBuild.cpp - the shape of a light tree, by a heuristic of surface and orientation. Layer:
// shading.
// SPDX-License-Identifier: MIT
//
// The emitters of a node are parted by the plane across one of the three axes for which this sum
// over both sides is least [Conty18, eq. 1]:
//
//   intensity * surface of the box * solid angle of the directions
//
// The solid angle is that of the cap whose mean direction is as long as the mean of the normals,
// widened by a right angle. The mean is a sum, unlike the cone of [Conty18], so that it costs
// little to find for each of the planes.
#include "osgRayTrace/shading/LightTree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kBins = 12;

/// A node with more emitters than this is parted across the longest axis alone.
constexpr std::size_t kLongestAxisOnly = 4096;

constexpr int kMostUneven = 40;

/// A node of no more emitters is one piece of work.
constexpr std::size_t kMostInSubtree = LightSubtree::kMostPairs + 1;

/// The part of an emitter's bounds that the build reads.
struct BuildEmitter
{
    Vec3 low, high;
    Vec3 flux; ///< intensity times normal; 0 for lights that shine to all sides
    float intensity;
    uint32_t index;

    Vec3 centre() const { return 0.5f * (low + high); }
};

struct Sums
{
    Vec3 low{kInfinity}, high{-kInfinity}, flux{0.0f};
    float intensity = 0.0f;

    void add(Vec3 l, Vec3 h, Vec3 f, float i)
    {
        low = glm::min(low, l);
        high = glm::max(high, h);
        flux += f;
        intensity += i;
    }
    void add(const Sums& o) { add(o.low, o.high, o.flux, o.intensity); }

    float cost() const
    {
        if (!(intensity > 0.0f)) return 0.0f;
        const Vec3 d = high - low;
        const float surface = d.x * d.y + d.y * d.z + d.z * d.x;
        // The mean direction over a cap of half-angle o has length (1 + cos o) / 2; the light of a
        // surface goes a right angle further.
        const float mean = std::min(glm::length(flux) / intensity, 1.0f);
        const float cosWide = -sineOf(2.0f * mean - 1.0f);
        return intensity * surface * (1.0f - cosWide);
    }
};

struct Split
{
    int axis = -1;
    float at = 0.0f;
    float cost = kInfinity;
};

BuildEmitter buildEmitter(const LightEmitter& emitter, uint32_t index)
{
    const LightBounds b = boundsOf(emitter);
    // The normals of what shines to both sides are taken to the same half of space.
    const float sum = b.axis.x + 2.0f * b.axis.y + 3.0f * b.axis.z;
    const float sign = b.twoSided && sum < 0.0f ? -1.0f : 1.0f;
    const float even = b.cosCone > 0.0f ? 1.0f : 0.0f;
    return {b.low, b.high, b.axis * (sign * even * b.intensity), b.intensity, index};
}

class Builder
{
public:
    Builder(const LightEmitters& emitters, const Workers* workers)
        : _workers(workers), _emitters(emitters.size())
    {
        forEachPart(workers, emitters.size(), kMostInSubtree,
                    [&](std::size_t begin, std::size_t end)
                    {
                        for (std::size_t i = begin; i < end; ++i)
                            _emitters[i] = buildEmitter(emitters[i], static_cast<uint32_t>(i));
                    });
        _pairs.children.resize(2 * emitters.size() - 2);
        _pairs.order.resize(emitters.size());
        _pairs.numbers.resize(emitters.size());
        _pairs.parents.resize(emitters.size() - 1, kInvalid);
        _pairs.leafNodes.resize(emitters.size());
    }

    /// Parts large nodes level by level, the nodes of a level at once, then all that is below at
    /// once.
    LightPairs build()
    {
        std::vector<Node> small, level{{0, _emitters.size(), 0, 0}};
        while (!level.empty())
        {
            std::vector<Node> large, next;
            for (const Node& node : level)
                (node.end - node.begin > kMostInSubtree ? large : small).push_back(node);
            std::vector<std::size_t> middles(large.size());
            forEachPart(_workers, large.size(), 1,
                        [&](std::size_t k, std::size_t) { middles[k] = part(large[k]); });
            for (std::size_t k = 0; k < large.size(); ++k)
            {
                _pairs.top.push_back(large[k].pair);
                for (const Node& child : setChildren(large[k], middles[k]))
                    if (child.end - child.begin > 1) next.push_back(child);
            }
            level = std::move(next);
        }
        for (const Node& node : small)
            _pairs.subtrees.push_back({node.pair,
                                       static_cast<uint32_t>(node.end - node.begin - 1),
                                       static_cast<uint32_t>(node.begin),
                                       {}});
        forEachPart(_workers, small.size(), 1,
                    [&](std::size_t k, std::size_t)
                    {
                        addBelow(small[k]);
                        _pairs.subtrees[k].setTurns(_pairs.children);
                    });
        for (std::size_t i = 0; i < _emitters.size(); ++i)
        {
            _pairs.order[i] = _emitters[i].index;
            _pairs.numbers[_emitters[i].index] = static_cast<uint32_t>(i);
        }
        return std::move(_pairs);
    }

private:
    /// Some emitters, and the pair that parts them.
    struct Node
    {
        std::size_t begin, end;
        int depth;
        uint32_t pair;
    };

    /// Sets the children of a node's pair, and returns them. The pairs of the first child come
    /// before those of the second, and there is one less than emitters.
    std::array<Node, 2> setChildren(const Node& node, std::size_t middle)
    {
        const auto before = static_cast<uint32_t>(middle - node.begin);
        const std::array<Node, 2> children{
            {{node.begin, middle, node.depth + 1, node.pair + 1},
             {middle, node.end, node.depth + 1, node.pair + before}}};
        for (std::size_t side = 0; side < 2; ++side)
        {
            const Node& child = children[side];
            const uint32_t number = 2 * node.pair + static_cast<uint32_t>(side);
            const auto leaf = static_cast<uint32_t>(child.begin);
            const bool isLeaf = child.end - child.begin == 1;
            _pairs.children[number] = isLeaf ? LightPairs::kLeaf | leaf : child.pair;
            (isLeaf ? _pairs.leafNodes[leaf] : _pairs.parents[child.pair]) = number;
        }
        return children;
    }

    void addBelow(const Node& node)
    {
        for (const Node& child : setChildren(node, part(node)))
            if (child.end - child.begin > 1) addBelow(child);
    }

    /// Puts the emitters of a node in order of their side. Returns the first one of the second
    /// side. Below kMostUneven levels the sides have as many emitters.
    std::size_t part(const Node& node)
    {
        const std::size_t begin = node.begin, end = node.end, count = end - begin;
        if (count == 2) return begin + 1;
        Vec3 low(kInfinity), high(-kInfinity);
        for (std::size_t i = begin; i < end; ++i)
        {
            low = glm::min(low, _emitters[i].centre());
            high = glm::max(high, _emitters[i].centre());
        }
        const Vec3 d = high - low;
        const int longest = d.x >= d.y && d.x >= d.z ? 0 : (d.y >= d.z ? 1 : 2);
        Split best;
        for (int axis = 0; axis < 3; ++axis)
            if (node.depth < kMostUneven && d[axis] > 0.0f &&
                (axis == longest || count <= kLongestAxisOnly))
                tryAxis(begin, end, axis, low[axis], d[axis], d[longest], best);
        BuildEmitter *const first = _emitters.data() + begin, *const last = _emitters.data() + end;
        if (best.axis >= 0)
        {
            const auto middle = std::partition(first, last,
                                               [&](const BuildEmitter& e)
                                               { return e.centre()[best.axis] < best.at; });
            const auto below = static_cast<std::size_t>(middle - first);
            if (below > 0 && below < count) return begin + below;
        }
        std::nth_element(first, first + static_cast<std::ptrdiff_t>(count / 2), last,
                         [longest](const BuildEmitter& a, const BuildEmitter& b)
                         { return a.centre()[longest] < b.centre()[longest]; });
        return begin + count / 2;
    }

    /// Sets best to the best plane across an axis, if there is a better one.
    void tryAxis(std::size_t begin, std::size_t end, int axis, float low, float extent,
                 float longest, Split& best) const
    {
        std::array<Sums, kBins> bins;
        const float scale = kBins / extent;
        for (std::size_t i = begin; i < end; ++i)
        {
            const BuildEmitter& e = _emitters[i];
            const auto bin = static_cast<std::size_t>((e.centre()[axis] - low) * scale);
            bins[std::min<std::size_t>(bin, kBins - 1)].add(e.low, e.high, e.flux, e.intensity);
        }
        std::array<float, kBins> above{};
        Sums sum;
        for (std::size_t k = kBins - 1; k > 0; --k)
        {
            sum.add(bins[k]);
            above[k] = sum.cost();
        }
        sum = {};
        for (std::size_t k = 0; k + 1 < kBins; ++k)
        {
            sum.add(bins[k]);
            // Thin boxes cost more [Conty18, sect. 4.4].
            const float cost = (sum.cost() + above[k + 1]) * longest / extent;
            if (cost < best.cost)
                best = {axis, low + extent * static_cast<float>(k + 1) / kBins, cost};
        }
    }

    const Workers* _workers;
    UnclearedArray<BuildEmitter> _emitters;
    LightPairs _pairs;
};

} // namespace

LightPairs lightPairs(const LightEmitters& emitters, const Workers* workers)
{
    return Builder(emitters, workers).build();
}

} // namespace osgRayTrace::engine
