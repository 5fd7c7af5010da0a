// NodeTree.h - many node paths in little memory. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Paths from below the decorator, each as one number: what paths have in common at their
/// beginnings is there once. A node of the tree takes 24 bytes and holds a reference to its
/// osg::Node, so that a path outlives what it leads to.
class NodeTree
{
public:
    static constexpr uint32_t kNone = 0xffffffffu;

    /// A path that begins with what stands for the decorator, and the decorator. In the order of a
    /// traversal. kNone: nothing is below.
    uint32_t add(const osg::NodePath& path);

    osg::Node& node(uint32_t entry) const { return *_entries[entry].node; }
    uint32_t parent(uint32_t entry) const { return _entries[entry].parent; }

    /// The first node on the way whose place or whose children's depends on who looks at them:
    /// billboards and the like, cameras, absolute transforms. kNone: all keep their places.
    uint32_t placedByView(uint32_t entry) const { return _entries[entry].placedByView; }

    /// The entries on the way to this one, the outermost first.
    void way(uint32_t entry, std::vector<uint32_t>& entries) const;

private:
    struct Entry
    {
        osg::ref_ptr<osg::Node> node;
        uint32_t parent = kNone;
        uint32_t placedByView = kNone;
    };

    std::vector<Entry> _entries;
    std::vector<uint32_t> _last; ///< the way of the path that was added last
};

} // namespace osgRayTrace::engine
