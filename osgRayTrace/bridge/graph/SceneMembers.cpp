// SceneMembers.cpp - records which nodes of unknown classes are in the scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/UnknownNode.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

using Nodes = std::unordered_set<const osg::Node*>;

/// Adds the nodes of unknown classes at and below a node, whether or not they are visible.
class UnknownNodes : public osg::NodeVisitor
{
public:
    explicit UnknownNodes(Nodes& found) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _found(found)
    {
        setNodeMaskOverride(~0u);
    }
    void apply(osg::Node& node) override
    {
        if (!_visited.insert(&node).second) return;
        if (isUnknown(node))
            _found.insert(&node);
        else
            traverse(node);
    }

private:
    Nodes& _found;
    Nodes _visited;
};

const osg::Node* outermostUnknown(const osg::NodePath& path)
{
    const auto outermost = std::find_if(path.begin(), path.end(),
                                        [](const osg::Node* node) { return isUnknown(*node); });
    return outermost == path.end() ? nullptr : *outermost;
}

} // namespace

/// Records that something at the end of the path is in the scene, if GraphWatch does not look at it
/// one by one.
void GraphCollector::recordInScene()
{
    const osg::NodePath& path = getNodePath();
    if (_untracked == 0 && !isUnknown(*path.back()) && !isUnknown(*path.front())) return;
    if (const osg::Node* outermost = outermostUnknown(path)) _graph.inScene.insert(outermost);
}

/// Records the same of all that is below the end of the path: nobody has looked there.
void GraphCollector::recordAllInScene()
{
    recordInScene();
    UnknownNodes visitor(_graph.inScene);
    getNodePath().back()->accept(visitor);
}

/// Records the clip planes that the node at the end of the path sets, if GraphWatch does not look
/// at them one by one. They are in the scene if they cut something that is.
void GraphCollector::recordPlanes(uint64_t numbers)
{
    const osg::Node* outermost = outermostUnknown(getNodePath());
    if (!outermost) return;
    _graph.unwatchedPlanes |= numbers;
    _unwatchedClips.emplace_back(outermost, numbers);
}

/// Finds at the end which clip planes are on for what is in the scene.
void GraphCollector::recordCuttingPlanes()
{
    for (const CollectedGeometry& geometry : _graph.geometries)
        for (const GeometryUse& use : geometry.uses)
            _graph.cuttingPlanes |= clipPlanesOn(_graph.states[use.state]);
    for (const auto& [node, numbers] : _unwatchedClips)
        if (numbers & _graph.cuttingPlanes) _graph.inScene.insert(node);
}

} // namespace osgRayTrace::engine
