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
#include "osgRayTrace/shading/LightNodes.h"
#include "osgRayTrace/shading/LightTree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kBins = 12;

/// A node with more emitters than this is parted across the longest axis alone.
constexpr std::size_t kLongestAxisOnly = 4096;

constexpr int kMostUneven = 40;

/// A node of no more emitters is one piece of work.
constexpr std::size_t kMostInSubtree = LightSubtree::kMostPairs + 1;

/// What the build reads of some emitters, in the widths of vectors. Of each four words x, y and z
/// are used.
struct Sums
{
    /// The low corner of the box, and the negated high one: to join boxes is to take the least.
    float box[8];

    /// Of intensity times normal, which is 0 for lights that shine to all sides; last the
    /// intensity.
    float flux[4];

    OSGRAYTRACE_INLINE void add(const Sums& o)
    {
        OSGRAYTRACE_SIMD
        for (int k = 0; k < 8; ++k)
            box[k] = o.box[k] < box[k] ? o.box[k] : box[k];
        OSGRAYTRACE_SIMD
        for (int k = 0; k < 4; ++k)
            flux[k] += o.flux[k];
    }
};

constexpr Sums kNothing = {
    {kInfinity, kInfinity, kInfinity, 0.0f, kInfinity, kInfinity, kInfinity, 0.0f}, {}};

struct alignas(64) BuildEmitter
{
    Sums own;
    uint32_t index;

    /// Returns a coordinate of twice the centre.
    OSGRAYTRACE_INLINE float twiceCentre(int axis) const
    {
        return own.box[axis] - own.box[axis + 4];
    }
};

/// The box around twice the centres of some emitters.
struct Centres
{
    float low[4], extent[4];
};

struct Split
{
    int axis = -1;
    float at = 0.0f; ///< twice the place of the plane
    float cost = kInfinity;
};

BuildEmitter buildEmitter(const LightEmitter& emitter, uint32_t index)
{
    const LightBounds b = boundsOf(emitter);
    // The normals of what shines to both sides are taken to the same half of space.
    const float sum = b.axis.x + 2.0f * b.axis.y + 3.0f * b.axis.z;
    const float sign = b.twoSided && sum < 0.0f ? -1.0f : 1.0f;
    const float even = b.cosCone > 0.0f ? 1.0f : 0.0f;
    const Vec3 flux = b.axis * (sign * even * b.intensity);
    BuildEmitter result{kNothing, index};
    for (int k = 0; k < 3; ++k)
    {
        result.own.box[k] = b.low[k];
        result.own.box[k + 4] = -b.high[k];
        result.own.flux[k] = flux[k];
    }
    result.own.flux[3] = b.intensity;
    return result;
}

OSGRAYTRACE_KERNEL
Centres centresOf(const BuildEmitter* emitters, std::size_t count)
{
    float low[4] = {kInfinity, kInfinity, kInfinity, 0.0f};
    float high[4] = {-kInfinity, -kInfinity, -kInfinity, 0.0f};
    for (std::size_t i = 0; i < count; ++i)
    {
        OSGRAYTRACE_SIMD
        for (int k = 0; k < 4; ++k)
        {
            const float centre = emitters[i].twiceCentre(k);
            low[k] = centre < low[k] ? centre : low[k];
            high[k] = centre > high[k] ? centre : high[k];
        }
    }
    Centres centres;
    for (int k = 0; k < 4; ++k)
    {
        centres.low[k] = low[k];
        centres.extent[k] = high[k] - low[k];
    }
    return centres;
}

/// Returns the bin of a place, whose distance from the first bin is this many bins.
OSGRAYTRACE_INLINE uint32_t binAt(float bins)
{
    return static_cast<uint32_t>(static_cast<int32_t>(least(bins, kBins - 1)));
}

/// The sums of emitters by their place along each axis.
using Bins = Sums[3][kBins];

OSGRAYTRACE_KERNEL
void addToBins(const BuildEmitter* emitters, std::size_t count, const Centres& centres, Bins& bins)
{
    float scale[4];
    for (int k = 0; k < 4; ++k)
        scale[k] = centres.extent[k] > 0.0f ? kBins / centres.extent[k] : 0.0f;
    for (std::size_t i = 0; i < count; ++i)
    {
        const BuildEmitter& e = emitters[i];
        uint32_t bin[4];
        OSGRAYTRACE_SIMD
        for (int k = 0; k < 4; ++k)
            bin[k] = binAt((e.twiceCentre(k) - centres.low[k]) * scale[k]);
        bins[0][bin[0]].add(e.own);
        bins[1][bin[1]].add(e.own);
        bins[2][bin[2]].add(e.own);
    }
}

OSGRAYTRACE_KERNEL
void addToBins(const BuildEmitter* emitters, std::size_t count, const Centres& centres, int axis,
               Bins& bins)
{
    const float low = centres.low[axis], scale = kBins / centres.extent[axis];
    for (std::size_t i = 0; i < count; ++i)
    {
        const BuildEmitter& e = emitters[i];
        bins[axis][binAt((e.twiceCentre(axis) - low) * scale)].add(e.own);
    }
}

/// What is on one side of each of the planes between bins.
struct Sides
{
    FloatLanes intensity{}, surface{}, flux2{};

    OSGRAYTRACE_INLINE void set(uint32_t plane, const Sums& s)
    {
        const auto k = static_cast<int>(plane);
        const float x = -s.box[4] - s.box[0], y = -s.box[5] - s.box[1], z = -s.box[6] - s.box[2];
        intensity[k] = s.flux[3];
        surface[k] = x * y + y * z + z * x;
        flux2[k] = s.flux[0] * s.flux[0] + s.flux[1] * s.flux[1] + s.flux[2] * s.flux[2];
    }

    OSGRAYTRACE_INLINE float cost(int k) const
    {
        const uint32_t shines = maskOf(intensity[k] > 0.0f);
        // The mean direction over a cap of half-angle o has length (1 + cos o) / 2; the light of a
        // surface goes a right angle further.
        const float length = std::sqrt(flux2[k]) / select(shines, intensity[k], 1.0f);
        const float cosWide = -sineOf(2.0f * least(length, 1.0f) - 1.0f);
        return select(shines, intensity[k] * surface[k] * (1.0f - cosWide), 0.0f);
    }
};

/// Returns what each of the planes between bins costs.
OSGRAYTRACE_KERNEL
FloatLanes planeCosts(const Sums* bins)
{
    static_assert(kBins <= kLanes);
    Sides below, above;
    Sums sum = kNothing;
    for (uint32_t k = 0; k + 1 < kBins; ++k)
    {
        sum.add(bins[k]);
        below.set(k, sum);
    }
    sum = kNothing;
    for (uint32_t k = kBins - 1; k > 0; --k)
    {
        sum.add(bins[k]);
        above.set(k - 1, sum);
    }
    FloatLanes costs;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        costs[i] = below.cost(i) + above.cost(i);
    return costs;
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
        _pairs.children.reuse(2 * emitters.size() - 2);
        _pairs.order.reuse(emitters.size());
        _pairs.numbers.reuse(emitters.size());
        _pairs.parents.reuse(emitters.size() - 1);
        _pairs.parents[0] = kInvalid;
        _pairs.leafNodes.reuse(emitters.size());
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
                        _pairs.subtrees[k].setTurns(_pairs.children.data());
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
        BuildEmitter *const first = _emitters.data() + begin, *const last = first + count;
        const Centres centres = centresOf(first, count);
        const float* const d = centres.extent;
        const int longest = d[0] >= d[1] && d[0] >= d[2] ? 0 : (d[1] >= d[2] ? 1 : 2);
        const Split best =
            node.depth < kMostUneven ? bestSplit(first, count, centres, longest) : Split{};
        if (best.axis >= 0)
        {
            const auto middle = std::partition(first, last,
                                               [&](const BuildEmitter& e)
                                               { return e.twiceCentre(best.axis) < best.at; });
            const auto below = static_cast<std::size_t>(middle - first);
            if (below > 0 && below < count) return begin + below;
        }
        std::nth_element(first, first + static_cast<std::ptrdiff_t>(count / 2), last,
                         [longest](const BuildEmitter& a, const BuildEmitter& b)
                         { return a.twiceCentre(longest) < b.twiceCentre(longest); });
        return begin + count / 2;
    }

    /// Returns the best plane; one without an axis if there is none.
    static Split bestSplit(const BuildEmitter* emitters, std::size_t count, const Centres& centres,
                           int longest)
    {
        if (!(centres.extent[longest] > 0.0f)) return {};
        const bool allAxes = count <= kLongestAxisOnly;
        Bins bins;
        std::fill_n(&bins[0][0], 3 * kBins, kNothing);
        if (allAxes)
            addToBins(emitters, count, centres, bins);
        else
            addToBins(emitters, count, centres, longest, bins);
        Split best;
        for (int axis = 0; axis < 3; ++axis)
        {
            const float extent = centres.extent[axis];
            if (!(extent > 0.0f) || (axis != longest && !allAxes)) continue;
            const FloatLanes costs = planeCosts(bins[axis]);
            const float thin =
                centres.extent[longest] / extent; // they cost more [Conty18, sect. 4.4]
            for (uint32_t k = 0; k + 1 < kBins; ++k)
            {
                const float cost = costs[static_cast<int>(k)] * thin;
                if (cost < best.cost)
                    best = {axis, centres.low[axis] + extent * static_cast<float>(k + 1) / kBins,
                            cost};
            }
        }
        return best;
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
