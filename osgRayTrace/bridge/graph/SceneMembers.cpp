// SceneMembers.cpp - records which nodes of unknown classes are in the scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/NodeKind.h"
#include "osgRayTrace/bridge/common/SceneRoot.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>
#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

using Nodes = std::unordered_set<const osg::Node*>;

bool isUnknown(const osg::Node& node)
{
    return kindOf(node) == NodeKind::Untracked && typeid(node) != typeid(SceneRoot);
}

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

} // namespace

/// Records that something at the end of the path is in the scene, if GraphWatch does not look at it
/// one by one.
void GraphCollector::recordInScene()
{
    const osg::NodePath& path = getNodePath();
    if (_untracked == 0 && !isUnknown(*path.back()) && !isUnknown(*path.front())) return;
    const auto outermost = std::find_if(path.begin(), path.end(),
                                        [](const osg::Node* node) { return isUnknown(*node); });
    if (outermost != path.end()) _graph.inScene.insert(*outermost);
}

/// Records the same of all that is below the end of the path: nobody has looked there.
void GraphCollector::recordAllInScene()
{
    recordInScene();
    UnknownNodes visitor(_graph.inScene);
    getNodePath().back()->accept(visitor);
}

} // namespace osgRayTrace::engine
