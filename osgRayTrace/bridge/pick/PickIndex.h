// PickIndex.h - leads from an instance back to the node path and the drawable. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/graph/NodeTree.h"
#include "osgRayTrace/bridge/pick/PrimitiveNumbers.h"

#include <osg/Geometry>

#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

struct CollectedGraph;

/// Belongs to one conversion and to the patches that add or remove nothing. The index takes 8 bytes
/// an instance, 16 bytes a geometry and the tree of paths. Any thread may use it.
class PickIndex
{
public:
    /// instances lists the instances of all uses of the graph's geometries in turn, kInvalid for
    /// uses that are not traced. The graph's paths are moved out of graph.
    PickIndex(CollectedGraph& graph, const std::vector<uint32_t>& instances);

    /// Tells the use of an instance in the graph.
    struct Use
    {
        uint32_t path = NodeTree::kNone; ///< kNone: the use is in a part
        uint32_t geometry = kInvalid;
    };

    /// Names a part that is left to osgUtil: drawn by OSG, placed by the view, or a lamp.
    struct Part
    {
        uint32_t path = NodeTree::kNone;
        /// Stands for the last node of the path; null: the node itself.
        osg::ref_ptr<osg::Node> inPlace;
    };

    const NodeTree& paths() const { return _paths; }
    const std::vector<Part>& parts() const { return _parts; } ///< in the order of the traversal
    Use use(uint32_t instance) const;

    /// Returns the geometry whose arrays the use's mesh was made of; for posed figures this is not
    /// the node of the graph.
    const osg::Geometry& geometry(const Use& use) const
    {
        return *_geometries[use.geometry].geometry;
    }

    /// Returns the primitive of a triangle. The numbers are made when the geometry is hit for the
    /// first time, which takes a walk through its primitives.
    GeometryTriangle triangle(const Use& use, const Mesh& mesh, uint32_t triangle) const;

private:
    struct Source
    {
        osg::ref_ptr<const osg::Geometry> geometry;
        PrimitiveRestart restart;
        bool solids; ///< points and lines are traced
    };

    void addPart(uint32_t path, osg::Node* inPlace);

    NodeTree _paths;
    std::vector<Use> _uses; ///< uses by instance
    std::vector<Source> _geometries;
    std::vector<Part> _parts;

    mutable std::mutex _mutex; // serializes threads that pick at once
    mutable std::unordered_map<uint32_t, std::shared_ptr<const PrimitiveNumbers>> _numbers;
};

} // namespace osgRayTrace::engine
