// BoxTree.h - boxes around items in space, sixteen to a node. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Holds corners of a box.
struct ItemBox
{
    Vec3 low{kInfinity}, high{-kInfinity};
};

/// Sorts items along a Z curve and puts a tree of boxes over them, sixteen items to a leaf and
/// sixteen boxes to a node. Each node tests its boxes in one loop over lanes. Immutable once built;
/// thread safe. The tree depends on the items and their order alone.
class BoxTree
{
public:
    /// Holds the spheres around sixteen boxes.
    struct Node
    {
        Vec3Lanes centre;
        FloatLanes radius; ///< negative: there is no box
    };

    BoxTree() = default;

    /// Sets order to the items' places in the tree: order[k] is the item at place k.
    BoxTree(const std::vector<ItemBox>& boxes, std::vector<uint32_t>& order);

    std::size_t size() const { return _size; }
    std::size_t bytes() const;

    /// Calls found(first, count) for each leaf, in ascending order, of which test(node) leaves the
    /// lane: its items are at the places from first on.
    template <class Test, class Found> void visit(const Test& test, const Found& found) const
    {
        if (_size > 0) visitNode(_levels.size() - 1, 0, test, found);
    }

private:
    template <class Test, class Found>
    void visitNode(std::size_t level, std::size_t node, const Test& test, const Found& found) const
    {
        for (const int i : lanesIn(test(_levels[level][node])))
        {
            const std::size_t child = node * kLanes + static_cast<std::size_t>(i);
            if (level > 0)
                visitNode(level - 1, child, test, found);
            else
                found(child * kLanes, std::min<std::size_t>(kLanes, _size - child * kLanes));
        }
    }

    std::size_t _size = 0;
    std::vector<std::vector<Node>> _levels; ///< from boxes over leaves up to one node
};

} // namespace osgRayTrace::engine
