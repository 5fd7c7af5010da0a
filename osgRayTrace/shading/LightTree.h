// LightTree.h - chooses one of many lights by what they may send to a point. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/LightEmitters.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// The shape of a LightTree over count emitters: count - 1 pairs of nodes. A child is the number of
/// a pair, which is above that of its parent, or kLeaf and the number of an emitter.
struct LightPairs
{
    static constexpr uint32_t kLeaf = 0x80000000u;

    std::vector<uint32_t> children; ///< two for each pair; pair 0 is the root's
    std::vector<uint32_t> order;    ///< the emitters in the order of the leaves
};

/// Returns a shape for emitters with these bounds, at least two: each pair parts the emitters of a
/// node where the sum of power times surface times solid angle is least [Conty18, sect. 4.4].
LightPairs lightPairs(const std::vector<LightBounds>& bounds);

/// A binary tree over emitters, which is descended from the root: at each pair of nodes one is
/// chosen in proportion to importance() [Conty18]. Emitters are numbered in the order of the
/// leaves, so that neighbours in number are neighbours in space. A tree never changes.
class LightTree
{
public:
    /// Takes at least two emitters.
    explicit LightTree(std::vector<LightEmitter> emitters);

    /// Takes the shape of a tree over as many emitters, which have moved or shine otherwise.
    LightTree(const LightTree& shape, std::vector<LightEmitter> emitters);

    std::size_t size() const { return _emitters.size(); }
    const LightEmitter& emitter(uint32_t number) const { return _emitters[number]; }
    const LightEmitter* emitters() const { return _emitters.data(); }

    /// Returns the number of the emitter that had this index in the constructor's list.
    uint32_t numberOf(std::size_t index) const { return _numbers[index]; }

    struct Choice
    {
        uint32_t emitter = kInvalid;
        float pmf = 0.0f;
    };
    /// Chooses an emitter for a surface point. normal: see importance(). u in [0,1).
    Choice choose(Vec3 p, Vec3 normal, float u) const;

    /// Returns the probability with which choose() takes an emitter; the sum over all is 1.
    float pmf(Vec3 p, Vec3 normal, uint32_t emitter) const;

    /// Chooses an emitter in each lane.
    void chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, const FloatLanes& u,
                     UintLanes& emitters, FloatLanes& pmf) const;

    /// Returns the sum over all nodes of intensity times radius, which grows as lights that were
    /// neighbours part.
    double spread() const { return _spread; }

    /// Returns the spread of the tree for which the shape was made.
    double spreadAtBuild() const { return _spreadAtBuild; }

    /// Returns whether the tree is that of these emitters, in the constructor's order.
    bool holds(const std::vector<LightEmitter>& emitters) const;

private:
    void setNodes();
    void setParents();

    std::shared_ptr<const LightPairs> _pairs;
    std::vector<LightEmitter> _emitters; ///< by number
    std::vector<uint32_t> _numbers;
    std::vector<LightNode> _nodes;    ///< two for each pair
    std::vector<uint32_t> _parents;   ///< by pair: the node above it; kInvalid at the root
    std::vector<uint32_t> _leafNodes; ///< by emitter: its node
    double _spread = 0.0, _spreadAtBuild = 0.0;
};

/// Returns the probability of the first node of a pair.
OSGRAYTRACE_INLINE float shareOfFirst(const LightNode& first, const LightNode& second, PlainVec3 p,
                                      PlainVec3 normal)
{
    // Rounding must not take the last chance of a node that may shine.
    constexpr float kLeastShare = 0x1p-20f;
    const float a = importance(first, p, normal), b = importance(second, p, normal);
    const float sum = a + b;
    const float share = select(maskOf(sum > 0.0f) & maskOf(sum < kInfinity), a / sum, 0.5f);
    const float above = select(share > kLeastShare, share, kLeastShare);
    const float within = select(above < 1.0f - kLeastShare, above, 1.0f - kLeastShare);
    const uint32_t both = maskOf(a > 0.0f) & maskOf(b > 0.0f);
    return select(both, within, share);
}

} // namespace osgRayTrace::engine
