// CullWatch.h - whether cull traversals still show what was converted. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"
#include "osgRayTrace/bridge/graph/CullOutcome.h"
#include "osgRayTrace/bridge/graph/DrawableTriangles.h"
#include "osgRayTrace/bridge/graph/RuleCaches.h"
#include "osgRayTrace/bridge/graph/SoftwareVertices.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

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

    /// unknown: there was such a subtree, but no view. reads is as in ViewingConditions.
    void record(std::vector<CullOutcome> outcomes, bool unknown,
                std::shared_ptr<const ShaderReads> reads);

    bool isEmpty() const { return _watched.empty() && !_unknown; }

    /// Decides again, under the present conditions of the input. Returns whether the outcomes are
    /// the same. A call looks at about 1000 drawables, the next one at those that follow. Nodes and
    /// callbacks of the application's run.
    bool holds(const ConversionInput& input, const Caches& caches);

    /// Returns whether a path leads through a node whose cull traversal stands for what is below.
    bool covers(const osg::NodePath& path) const;

private:
    /// Holds hashes of the values of a traced leaf as it was converted.
    struct LeafValues
    {
        std::vector<uint64_t> states;
        uint64_t content = 0;
    };

    struct Watched
    {
        CullOutcome outcome;
        std::vector<LeafValues> values; ///< of the outcome's traced leaves
    };

    bool holds(Watched& watched, const ConversionInput& input, const Caches& caches);
    bool isInPlain(const CullOutcome& outcome) const;
    uint64_t hashOf(const osg::StateSet& stateSet) const;
    uint64_t hashOf(osg::Drawable& drawable) const;
    LeafValues valuesOf(const CapturedLeaf& leaf) const;
    bool sameValues(const osg::StateSet& before, uint64_t hashBefore,
                    const osg::StateSet& now) const;
    bool isSame(const Watched& before, const CullOutcome& now, double eyeDistance) const;

    std::vector<Watched> _watched;
    ViewingConditions _plain; ///< conditions of hashes of single drawables: reads alone
    bool _unknown = false;
    std::size_t _next = 0;   ///< index of the subtree to look at
    std::size_t _credit = 0; ///< drawables that calls have left
    std::size_t _rounds = 0; ///< looks at all subtrees
    /// Subtree that was found as it had been, with all nested ones that are plain.
    const CullOutcome* _plainAbove = nullptr;
};

} // namespace osgRayTrace::engine
