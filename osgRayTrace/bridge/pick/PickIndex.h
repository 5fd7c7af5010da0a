// PickIndex.h - from an instance back to the node path and the drawable. Layer: bridge.
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

/// Of one conversion and those that patch it without adding or removing anything. Takes 8 bytes an
/// instance, 16 a geometry and the tree of paths. Any thread.
class PickIndex
{
public:
    /// instances: of all uses of the graph's geometries in turn, kInvalid for what is not traced.
    /// Takes the graph's paths.
    PickIndex(CollectedGraph& graph, const std::vector<uint32_t>& instances);

    /// What an instance is in the graph.
    struct Use
    {
        uint32_t path = NodeTree::kNone; ///< kNone: it is in a part
        uint32_t geometry = kInvalid;
    };

    /// What is left to osgUtil: drawn by OSG, placed by the view, or a lamp.
    struct Part
    {
        uint32_t path = NodeTree::kNone;
        osg::ref_ptr<osg::Node> inPlace; ///< of the last node; null: itself
    };

    const NodeTree& paths() const { return _paths; }
    const std::vector<Part>& parts() const { return _parts; } ///< in the order of the traversal
    Use use(uint32_t instance) const;

    /// Whose arrays the use's mesh was made of: of posed figures not the node of the graph.
    const osg::Geometry& geometry(const Use& use) const
    {
        return *_geometries[use.geometry].geometry;
    }

    /// Made when the geometry is hit for the first time, which takes a walk through its primitives.
    GeometryTriangle triangle(const Use& use, const Mesh& mesh, uint32_t triangle) const;

private:
    struct Source
    {
        osg::ref_ptr<const osg::Geometry> geometry;
        PrimitiveRestart restart;
    };

    void addPart(uint32_t path, osg::Node* inPlace);

    NodeTree _paths;
    std::vector<Use> _uses; ///< by instance
    std::vector<Source> _geometries;
    std::vector<Part> _parts;

    mutable std::mutex _mutex; // threads that pick at once
    mutable std::unordered_map<uint32_t, std::shared_ptr<const PrimitiveNumbers>> _numbers;
};

} // namespace osgRayTrace::engine
