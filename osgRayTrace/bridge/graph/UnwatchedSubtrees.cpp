// UnwatchedSubtrees.cpp - records to which unwatched subtree what is collected belongs. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/UnknownNode.h"

#include <algorithm>

namespace osgRayTrace::engine
{

/// Returns the index of the subtree in which the end of the path is, which may be a new one;
/// kNoSubtree: GraphWatch looks at all nodes of the path.
uint32_t GraphCollector::subtree()
{
    const osg::NodePath& path = getNodePath();
    if (path.empty()) return kNoSubtree;
    if (_untracked == 0 && _captured == 0 && !isUnknown(*path.back()) && !isUnknown(*path.front()))
        return kNoSubtree;
    std::vector<UnwatchedSubtree>& subtrees = _graph.subtrees;
    const auto isIn = [&path](const osg::NodePath& above)
    { return above.size() <= path.size() && std::equal(above.begin(), above.end(), path.begin()); };
    if (subtrees.empty() || !isIn(subtrees.back().path))
    {
        const auto unknown = std::find_if(path.begin(), path.end(),
                                          [](const osg::Node* node) { return isUnknown(*node); });
        auto length = static_cast<std::size_t>(unknown - path.begin()) + 1;
        if (_captured > 0) length = std::min(length, _captured);
        if (length > path.size()) return kNoSubtree;
        UnwatchedSubtree& fresh = subtrees.emplace_back();
        fresh.path.assign(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(length));
        fresh.parts = _graph.rasterized.size();
    }
    return static_cast<uint32_t>(subtrees.size() - 1);
}

/// Records that the node at the end of the path is in the scene, and shines or places state.
void GraphCollector::recordSpecial()
{
    recordInScene();
    if (const uint32_t in = subtree(); in != kNoSubtree) _graph.subtrees[in].special = true;
}

/// Records that OSG draws a geometry without a part of its own.
void GraphCollector::leave(const osg::Geometry& geometry)
{
    _graph.leftGeometries.push_back(&geometry);
    if (const uint32_t in = subtree(); in != kNoSubtree)
        _graph.subtrees[in].left.push_back(&geometry);
}

} // namespace osgRayTrace::engine
