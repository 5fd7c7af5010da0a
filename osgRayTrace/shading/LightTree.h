// LightTree.h - chooses one of many lights by what they may send to a point. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/LightEmitters.h"
#include "osgRayTrace/shading/LightSteps.h"
#include "osgRayTrace/shading/LightSubtree.h"

#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// The shape of a LightTree over count emitters: count - 1 pairs of nodes. A child is the number of
/// a pair, which is above that of its parent, or kLeaf and the number of an emitter. The pairs
/// below a pair, and the leaves below it, are numbered without gaps.
struct LightPairs
{
    static constexpr uint32_t kLeaf = 0x80000000u;

    UnclearedArray<uint32_t> children;  ///< two for each pair; pair 0 is the root's
    UnclearedArray<uint32_t> order;     ///< the emitters in the order of the leaves
    UnclearedArray<uint32_t> numbers;   ///< by emitter: its leaf
    UnclearedArray<uint32_t> parents;   ///< by pair: the node above it; kInvalid at the root
    UnclearedArray<uint32_t> leafNodes; ///< by leaf: its node
    std::vector<LightSubtree> subtrees; ///< disjoint ones, which threads work on at once
    std::vector<uint32_t> top;          ///< the pairs above them, each after its parent
};

/// Returns a shape for at least two emitters: each pair parts the emitters of a node where the sum
/// of power times surface times solid angle is least [Conty18, sect. 4.4]. The shape is the same
/// for any workers, which may be null.
LightPairs lightPairs(const LightEmitters& emitters, const Workers* workers);

/// The large arrays of a LightTree.
struct LightArrays
{
    LightEmitters emitters;          ///< by number
    UnclearedArray<LightNode> nodes; ///< two for each pair
};

/// Keeps the arrays of a tree that is gone for the next tree of its shape: to clear new pages takes
/// as long as to fill them, and a mesh may deform in each frame. Thread safe.
class SpareLightArrays
{
public:
    /// Returns arrays for this number of emitters.
    LightArrays take(std::size_t emitters);

    void give(LightArrays&& arrays); ///< Keeps these, and frees what was kept.

    /// Frees what is kept.
    void clear() { give({}); }

    bool isEmpty();

private:
    std::mutex _mutex;
    LightArrays _arrays;
};

/// A binary tree over emitters, which is descended from the root by steps of two levels: among the
/// nodes that a step may lead to one is chosen in proportion to importance() [Conty18]; see
/// LightSteps.h. Emitters are numbered in the order of the leaves, so that neighbours in number are
/// neighbours in space. A tree never changes.
class LightTree
{
public:
    /// Takes at least two emitters. workers: threads that build the tree; null: the calling thread
    /// does. The tree does not depend on them.
    explicit LightTree(const LightEmitters& emitters, const Workers* workers = nullptr);

    /// Takes the shape of a tree over as many emitters, which have moved or shine otherwise.
    LightTree(const LightTree& shape, const EmitterSource& source,
              const Workers* workers = nullptr);
    ~LightTree();

    /// Returns a tree over count emitters, at least two: one of previous's shape if that has as
    /// many, and they have not moved far apart; else a tree with a shape of its own. previous,
    /// workers: may be null.
    static std::shared_ptr<const LightTree> after(const LightTree* previous,
                                                  const EmitterSource& source, std::size_t count,
                                                  const Workers* workers);

    std::size_t size() const { return _arrays.emitters.size(); }

    /// Frees the memory that is kept for the next tree of this shape.
    void clearSpare() const { _spare->clear(); }
    bool hasSpare() const { return !_spare->isEmpty(); }

    /// Returns bounds of all its lights.
    const LightBounds& bounds() const { return _bounds; }
    const LightEmitter& emitter(uint32_t number) const { return _arrays.emitters[number]; }
    const LightEmitter* emitters() const { return _arrays.emitters.data(); }

    /// Returns whether some emitter may be sampled by solid angle.
    bool hasRectangles() const { return _hasRectangles; }

    /// Returns the number of the emitter that had this index in the constructor's list.
    uint32_t numberOf(std::size_t index) const { return _pairs->numbers[index]; }

    struct Choice
    {
        uint32_t emitter = kInvalid;
        float pmf = 0.0f;
    };
    /// Chooses an emitter for a surface point. normal: see importance(). u in [0,1), which is set
    /// to what is left of it to choose more.
    Choice choose(Vec3 p, Vec3 normal, float& u) const;

    /// Returns the probability with which choose() takes an emitter; the sum over all is 1.
    float pmf(Vec3 p, Vec3 normal, uint32_t emitter) const;

    /// One choice of each lane.
    struct Pick
    {
        FloatLanes u; ///< in [0,1); set to what is left of it
        UintLanes emitters;
        FloatLanes pmf;
        LaneMask open; ///< lanes that have not come to an emitter
    };
    /// Chooses count emitters in each lane.
    void chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, Pick* picks,
                     std::size_t count) const;

    /// Returns the sum over all nodes of intensity times radius, which grows as lights that were
    /// neighbours part.
    double spread() const { return _spread; }

    /// Returns the spread of the tree for which the shape was made.
    double spreadAtBuild() const { return _spreadAtBuild; }

private:
    struct Joined ///< what is known of a pair that is set
    {
        LightBounds bounds;      ///< of the lights below
        double spread = 0.0;     ///< of the nodes that were set with it
        bool points = false;     ///< whether leaves that were set with it are point lights
        bool rectangles = false; ///< whether leaves that were set with it are rectangles

        void addLeaf(const LightEmitter& emitter)
        {
            points |= emitter.isPoint();
            rectangles |= (emitter.flags & kRectangle) != 0;
        }
    };
    using JoinedPairs = std::unordered_map<uint32_t, Joined>;

    struct Step
    {
        uint32_t nodes[4] = {}; ///< by place
        StepWeights weights;
    };
    Step stepFrom(uint32_t pair, Vec3 p, Vec3 normal) const;

    void setNodes(const EmitterSource& source, const Workers* workers);
    Joined setSubtree(const LightSubtree& subtree, const EmitterSource& source);
    Joined setTop(uint32_t pair, const EmitterSource& source, const JoinedPairs& below);

    std::shared_ptr<const LightPairs> _pairs;
    std::shared_ptr<SpareLightArrays> _spare; ///< of all trees of this shape
    LightArrays _arrays;
    bool _areasOnly = true;      ///< no emitter is a point light
    bool _hasRectangles = false; ///< some emitter is a rectangle
    double _spread = 0.0, _spreadAtBuild = 0.0;
    LightBounds _bounds;
};

} // namespace osgRayTrace::engine
