// SceneLightTree.h - a light tree in two levels: over a scene, and over its large moving meshes.
// Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/MeshLightTree.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Chooses one emitter of a scene. A LightTree over the scene has one leaf for each mesh with a
/// tree of its own; below it the point that is to be lit is taken to the space of the mesh, as rays
/// are taken to an instance. Emitters are numbered in the order of the leaves, through both levels.
/// A tree never changes.
class SceneLightTree
{
public:
    /// emitters: at least one; those that stand for meshes come in the order of placed. source: of
    /// these emitters; it is not kept. previous: see LightTree::after; it may be null, and so may
    /// workers.
    SceneLightTree(SceneEmitters emitters, const EmitterSource& source,
                   std::vector<PlacedLightTree> placed, const SceneLightTree* previous,
                   const Workers* workers);

    /// Returns how many emitters there are; each triangle of a mesh is one.
    std::size_t size() const { return _size; }

    LightEmitter emitter(uint32_t number) const
    {
        return _placed.empty() ? _top->emitter(number) : placedEmitter(number);
    }

    /// Emitters for sixteen lanes: lane i reads emitters[at[i]].
    struct Gathered
    {
        const LightEmitter* emitters;
        UintLanes at;
        LightEmitter held[kLanes]; ///< set if there are meshes with trees of their own

        const LightEmitter& of(int lane) const { return emitters[at[lane]]; }
    };
    /// Sets the emitters of these numbers, which the tree must outlive.
    void gather(const UintLanes& numbers, Gathered& gathered) const;

    /// Returns whether some emitter may be sampled by solid angle.
    bool hasRectangles() const { return _top && _top->hasRectangles(); }

    using Choice = LightTree::Choice;
    /// Chooses an emitter for a surface point. normal: see importance(). u in [0,1).
    Choice choose(Vec3 p, Vec3 normal, float u) const;

    /// Returns the probability with which choose() takes an emitter; the sum over all is 1.
    float pmf(Vec3 p, Vec3 normal, uint32_t emitter) const
    {
        return _placed.empty() ? _top->pmf(p, normal, emitter) : placedPmf(p, normal, emitter);
    }

    using Pick = LightTree::Pick;
    /// Chooses count emitters in each lane. To choose some at once takes less time than one by one.
    void chooseLanes(const Vec3Lanes& p, const Vec3Lanes& normal, Pick* picks,
                     std::size_t count) const;

    /// Returns the tree over the scene; null if it has one leaf.
    const std::shared_ptr<const LightTree>& top() const { return _top; }

    const std::vector<PlacedLightTree>& placed() const { return _placed; }

    /// Returns the leaves of the tree over the scene. A leaf is an emitter, or stands for a mesh.
    std::size_t leaves() const { return _leaves; }
    const LightEmitter& leaf(uint32_t number) const { return _top ? _top->emitter(number) : _only; }

    /// Returns the number of the emitter that is a leaf, or of the first emitter below it.
    uint32_t firstOf(uint32_t leaf) const { return _placed.empty() ? leaf : _first[leaf]; }

    /// Returns the number of the emitter with this index in the constructor's list, which does not
    /// stand for a mesh.
    uint32_t numberOfIndex(std::size_t index) const
    {
        return firstOf(_top ? _top->numberOf(index) : 0);
    }

    /// Returns the number of a triangle of a mesh with a tree of its own; kInvalid: none.
    uint32_t numberOf(uint32_t placed, uint32_t primitive) const
    {
        const uint32_t below = _placed[placed].own->numberOf(primitive);
        return below == kInvalid ? kInvalid : _first[_leafOf[placed]] + below;
    }

    /// Returns whether the tree is that of these emitters and meshes.
    bool holds(const SceneEmitters& emitters, const std::vector<PlacedLightTree>& placed) const
    {
        return _placed == placed && _emitters == emitters;
    }

private:
    void choosePlaced(const Vec3Lanes& p, const Vec3Lanes& normal, Pick& pick) const;
    uint32_t leafOfNumber(uint32_t number) const;
    LightEmitter placedEmitter(uint32_t number) const;
    float placedPmf(Vec3 p, Vec3 normal, uint32_t number) const;

    SceneEmitters _emitters;
    std::shared_ptr<const LightTree> _top;
    LightEmitter _only{}; ///< the leaf if there is no tree over the scene
    std::vector<PlacedLightTree> _placed;
    std::size_t _leaves = 0, _size = 0;
    // These are empty without meshes that have trees of their own.
    std::vector<uint32_t> _first;    ///< by leaf: number of its first emitter
    std::vector<uint32_t> _placedOf; ///< by leaf: index into _placed; kInvalid: an emitter
    std::vector<uint32_t> _leafOf;   ///< by index into _placed
};

} // namespace osgRayTrace::engine
