// CullWatch.h - whether cull traversals still show what was converted. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/graph/CollectedGraph.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"
#include "osgRayTrace/bridge/graph/CullOutcome.h"
#include "osgRayTrace/bridge/graph/CullRepetition.h"
#include "osgRayTrace/bridge/graph/DrawableTriangles.h"
#include "osgRayTrace/bridge/graph/RuleCaches.h"
#include "osgRayTrace/bridge/graph/SoftwareVertices.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace osgRayTrace::engine
{

/// Lists what cull traversals show otherwise than it was converted.
struct CullChanges
{
    bool holds = true;    ///< false: the graph must be converted again
    bool complete = true; ///< false: the look has left out subtrees
    std::vector<MovedUse> moved;
    std::vector<const osg::Geometry*> deformed; ///< other positions, normals or primitives
    std::vector<CullSplice> splices;
    std::vector<osg::NodePath> others; ///< nodes whose cull traversal shows more that is different
};

/// Holds the decisions on the subtrees that may draw in cull alone, and repeats them.
class CullWatch
{
public:
    /// Names what a GraphCollector looks up in its conversion's caches.
    struct Caches
    {
        SoftwareVertices& vertices;
        DrawableTriangles& triangles;
        const TextureConverter& textures;
        RuleCaches& rules;
    };

    /// Takes the outcomes of the graph, after all that is not traced has been dropped from its
    /// geometries. reads is as in ViewingConditions.
    void record(CollectedGraph& graph, std::shared_ptr<const ShaderReads> reads);

    /// Names the part of the scene that each leaf has become, by its number.
    using LeafUses = std::unordered_map<uint32_t, ChangedUse>;

    /// Takes the outcomes at and below the last node of a path from a graph that was collected
    /// there, in place of those that it has.
    void replace(const osg::NodePath& path, CollectedGraph& graph, const LeafUses& uses);

    /// Takes that those uses of a geometry are gone which have these numbers, which ascend, and
    /// that so many are left.
    void renumber(const osg::Geometry& geometry, const std::vector<uint32_t>& gone, uint32_t left);

    bool isEmpty() const { return _watched.empty() && !_unknown; }

    /// Decides again, under the present conditions of the input. A call looks at about 1000
    /// drawables, the next one at those that follow. Nodes and callbacks of the application's run.
    /// The changes count as made, so they must be, or the graph must be converted.
    CullChanges look(const ConversionInput& input, const Caches& caches);

    /// Returns the nodes whose cull traversal stands for what is below.
    const std::unordered_set<const osg::Node*>& captured() const { return _captured; }

    /// Returns whether a path leads through a node whose cull traversal stands for what is below.
    bool covers(const osg::NodePath& path) const;

private:
    /// Holds a leaf that is in the traced scene, as it was converted.
    struct WatchedLeaf
    {
        ChangedUse use;               ///< its part in the scene; without a geometry there is none
        std::vector<uint64_t> states; ///< hashes of the values of its state sets
        uint64_t content = 0;         ///< hash of the drawable
        uint64_t attributes = 0;      ///< hash of what of the drawable is no part of its shape
    };

    struct Watched
    {
        CullOutcome outcome;                 ///< without leaves
        bool drawn = false;                  ///< CullOutcome::isDrawn()
        std::vector<CulledLeaf> leaves;      ///< those in the scene
        std::vector<WatchedLeaf> values;     ///< of those leaves
        std::size_t captured = 0;            ///< number of all leaves of the cull traversal
        uint64_t signature = 0;              ///< CullRecord::signature()
        uint64_t content = 0;                ///< hash of all values that the outcome depends on
        std::map<std::string, int64_t> left; ///< numbers of leaves that OSG draws, by their reason
    };

    Watched watchedOf(CullOutcome& outcome, const LeafUses& uses) const;
    bool lookAt(Watched& watched, CullRepetition& repetition, const ConversionInput& input,
                const Caches& caches, CullChanges& changes);
    bool isInPlain(const CullOutcome& outcome) const;
    uint64_t contentOf(const CullOutcome& outcome) const;
    uint64_t hashOf(const osg::StateSet& stateSet) const;
    uint64_t hashOf(osg::Drawable& drawable) const;
    WatchedLeaf valuesOf(const CulledLeaf& leaf) const;
    bool sameStates(const CulledLeaf& before, const WatchedLeaf& values,
                    const CulledLeaf& now) const;
    bool compare(Watched& before, CullOutcome& now, double eyeDistance, CullChanges& changes) const;
    bool spliceLeaves(Watched& before, const CullOutcome& now, double eyeDistance,
                      CullChanges& changes, CullSplice& splice) const;
    bool compare(CulledLeaf& before, WatchedLeaf& values, const CulledLeaf& now, double eyeDistance,
                 CullChanges& changes) const;

    std::vector<Watched> _watched;
    std::unordered_set<const osg::Node*> _captured;
    ViewingConditions _plain; ///< conditions of hashes of single drawables: reads alone
    bool _unknown = false;
    std::size_t _next = 0;   ///< index of the subtree to look at
    std::size_t _credit = 0; ///< drawables that calls have left
    std::size_t _rounds = 0; ///< looks at all subtrees
    /// Subtree that was found as it had been, with all nested ones that are plain.
    const CullOutcome* _plainAbove = nullptr;
};

} // namespace osgRayTrace::engine
