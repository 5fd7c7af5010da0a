// StoredView.cpp - finds the nodes that describe a view. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StoredView.h"

#include <osg/Camera>
#include <osg/CameraView>
#include <osg/ClearNode>
#include <osg/NodeVisitor>

#include <set>

namespace osgRayTrace::app
{

namespace
{

/// Finds the first node of a class, and its place: the node's own transform is part of the matrix.
template <typename NodeClass> class FindFirst : public osg::NodeVisitor
{
public:
    FindFirst() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}

    /// Visits each node once, however many paths lead to it.
    void apply(osg::Node& node) override
    {
        if (!found && _visited.insert(&node).second) traverse(node);
    }

    void apply(NodeClass& node) override
    {
        if (!found) worldFromNode = osg::computeLocalToWorld(getNodePath());
        if (!found) found = &node;
    }
    using osg::NodeVisitor::apply;

    osg::ref_ptr<NodeClass> found;
    osg::Matrixd worldFromNode;

private:
    std::set<osg::ref_ptr<osg::Node>> _visited;
};

/// Collects the cameras of models, each once for each path.
class FindCameras : public osg::NodeVisitor
{
public:
    FindCameras() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Camera& camera) override
    {
        if (camera.getName().empty() || camera.getNumChildren() > 0) return traverse(camera);
        Placement placement;
        double aspect = 0.0, nearest = 0.0, farthest = 0.0;
        double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
        if (camera.getProjectionMatrixAsOrtho(left, right, bottom, top, nearest, farthest))
            placement.height = top - bottom;
        else if (!camera.getProjectionMatrixAsPerspective(placement.fovyDegrees, aspect, nearest,
                                                          farthest))
            return;
        const osg::NodePath above(getNodePath().begin(), getNodePath().end() - 1);
        const osg::Matrixd worldFromEye =
            camera.getInverseViewMatrix() * osg::computeLocalToWorld(above);
        placement.eye = worldFromEye.getTrans();
        osg::Vec3d sight = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, -1.0), worldFromEye);
        sight.normalize();
        placement.center = placement.eye + sight;
        placement.up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 1.0, 0.0), worldFromEye);
        found.push_back({camera.getName(), placement});
    }
    using osg::NodeVisitor::apply;

    std::vector<NamedPlacement> found;
};

} // namespace

std::vector<NamedPlacement> namedPlacements(osg::Node& scene)
{
    FindCameras find;
    scene.accept(find);
    return find.found;
}

std::optional<Placement> storedPlacement(osg::Node& scene)
{
    FindFirst<osg::CameraView> find;
    scene.accept(find);
    if (!find.found || find.found->getFieldOfViewMode() != osg::CameraView::VERTICAL)
        return std::nullopt;

    Placement placement;
    placement.eye = find.worldFromNode.getTrans();
    placement.center =
        placement.eye + osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, -1.0), find.worldFromNode);
    placement.up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 1.0, 0.0), find.worldFromNode);
    placement.fovyDegrees = find.found->getFieldOfView();
    return placement;
}

std::optional<osg::Vec4> storedClearColor(osg::Node& scene)
{
    FindFirst<osg::ClearNode> find;
    scene.accept(find);
    if (!find.found) return std::nullopt;
    return find.found->getClearColor();
}

} // namespace osgRayTrace::app
