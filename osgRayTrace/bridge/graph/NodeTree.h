// NodeTree.h - stores many node paths in little memory. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds paths from below the decorator, each as one number; common beginnings of paths are stored
/// once. A node of the tree takes 24 bytes and holds a reference to its osg::Node, so that a path
/// outlives the nodes that it leads to.
class NodeTree
{
public:
    static constexpr uint32_t kNone = 0xffffffffu;

    /// Adds a path, which begins with the node that stands for the decorator and with the
    /// decorator. Paths come in the order of a traversal. Returns kNone if nothing is below the
    /// decorator.
    uint32_t add(const osg::NodePath& path);

    osg::Node& node(uint32_t entry) const { return *_entries[entry].node; }
    uint32_t parent(uint32_t entry) const { return _entries[entry].parent; }

    /// Returns the first node on the way whose place, or whose children's place, depends on the
    /// view: billboards and the like, cameras, absolute transforms. kNone: all nodes keep their
    /// places.
    uint32_t placedByView(uint32_t entry) const { return _entries[entry].placedByView; }

    /// Sets entries to the way to this entry, the outermost one first.
    void way(uint32_t entry, std::vector<uint32_t>& entries) const;

private:
    struct Entry
    {
        osg::ref_ptr<osg::Node> node;
        uint32_t parent = kNone;
        uint32_t placedByView = kNone;
    };

    std::vector<Entry> _entries;
    std::vector<uint32_t> _last; ///< way of the path that was added last
};

} // namespace osgRayTrace::engine
