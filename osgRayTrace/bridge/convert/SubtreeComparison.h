// SubtreeComparison.h - compares what was collected with what the scene has of it. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"
#include "osgRayTrace/bridge/convert/ConversionState.h"
#include "osgRayTrace/scene/Scene.h"

#include <unordered_map>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Compares the geometries of an unwatched subtree, which was collected again. All that it is given
/// must live as long as it does.
class SubtreeComparison
{
public:
    SubtreeComparison(const ConversionInput& input, const CollectedGraph& graph, const Scene& scene,
                      ConversionCaches& caches, const ConvertedGraph& convertedGraph,
                      uint32_t subtree);

    /// Returns whether all uses of a geometry are in the scene as they would be made now, but for
    /// their materials: materials() has those that are others.
    bool isSame(const CollectedGeometry& geometry);

    /// Returns instances with the materials that they should have.
    std::vector<std::pair<uint32_t, Material>>& materials() { return _others; }

private:
    bool isSame(const CollectedGeometry& geometry, const GeometryUse& use, const TracedUse& traced);

    const ConversionInput& _input;
    const CollectedGraph& _graph;
    const Scene& _scene;
    ConversionCaches& _caches;
    const ConvertedGraph& _convertedGraph;
    uint32_t _subtree;
    ConversionReport _report;
    MaterialConverter _materials;
    std::unordered_map<const osg::Geometry*, std::vector<uint64_t>> _places;
    std::vector<std::pair<uint32_t, Material>> _others;
};

/// Returns the numbers of those uses of a geometry that are in a subtree.
std::vector<uint32_t> usesIn(const TracedGeometry& traced, uint32_t subtree);

} // namespace osgRayTrace::engine
