// ConvertedSubtree.h - what unwatched subtrees have become, to be compared with what they are
// later. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/graph/CollectedGraph.h"

#include <osg/Geometry>
#include <osg/Matrixd>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

struct ConvertedSubtree : UnwatchedSubtree
{
    struct Place
    {
        const osg::Geometry* geometry = nullptr;
        uint64_t hash = 0; ///< see placeHash()
    };
    std::vector<Place> places; ///< of its uses, those of one geometry in the order of the traversal
};

/// Holds the unwatched subtrees of a converted graph, and what OSG draws of the graph.
struct ConvertedSubtrees
{
    std::vector<ConvertedSubtree> all; ///< in the order of the traversal; indices stay
    std::shared_ptr<const RasterizedParts> parts = std::make_shared<RasterizedParts>();
    std::vector<uint32_t> partSubtrees; ///< CollectedGraph::rasterizedSubtrees
    std::vector<Enclosure> enclosures;  ///< CollectedGraph::enclosures, where they are now

    /// Takes the lists of a graph, without its parts.
    void record(CollectedGraph& graph);

    /// Returns the index of the subtree in which a path from the root ends; kNoSubtree: there is
    /// none, or several are at the same path.
    uint32_t find(const osg::NodePath& path) const;

    /// Returns what the only use of a geometry is; null: it is no enclosure.
    Enclosure* enclosure(const osg::Geometry& geometry);

    /// Exchanges the parts of a subtree.
    void setParts(uint32_t subtree, RasterizedParts fresh);
};

/// Returns a hash of a place.
uint64_t placeHash(const osg::Matrixd& engineFromLocal);

/// Returns the places of the uses of a graph that was collected from one subtree.
std::vector<ConvertedSubtree::Place> placesOf(const CollectedGraph& graph);

} // namespace osgRayTrace::engine
