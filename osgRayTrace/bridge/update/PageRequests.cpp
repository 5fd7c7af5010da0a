// PageRequests.cpp - runs a cull traversal that draws nothing. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/PageRequests.h"

#include "osgRayTrace/bridge/graph/PathBudget.h"

#include <osg/Camera>
#include <osg/PagedLOD>
#include <osg/Projection>
#include <osg/ProxyNode>
#include <osg/Transform>
#include <osgUtil/CullVisitor>

#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// Visits pages. Pages alone see a cull visitor: other nodes may take any such visitor for an
/// osgUtil::CullVisitor, or do their work of the frame twice.
class PageVisitor : public osg::NodeVisitor, public osg::CullStack
{
public:
    explicit PageVisitor(osgUtil::CullVisitor& visitor)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN)
    {
        setCullSettings(visitor);
        setTraversalMask(visitor.getTraversalMask());
        setNodeMaskOverride(visitor.getNodeMaskOverride());
        setTraversalNumber(visitor.getTraversalNumber());
        setFrameStamp(const_cast<osg::FrameStamp*>(visitor.getFrameStamp()));
        setDatabaseRequestHandler(visitor.getDatabaseRequestHandler());
        getNodePath() = visitor.getNodePath();
        pushViewport(visitor.getViewport());
        pushProjectionMatrix(visitor.getProjectionMatrix());
        pushModelViewMatrix(visitor.getModelViewMatrix(), osg::Transform::RELATIVE_RF);
    }

    using osg::NodeVisitor::apply;

    void apply(osg::Node& node) override { enter(node, NODE_VISITOR); }
    void apply(osg::PagedLOD& node) override { enter(node, CULL_VISITOR); }
    void apply(osg::ProxyNode& node) override { enter(node, CULL_VISITOR); }
    void apply(osg::Drawable&) override {}
    void apply(osg::Camera&) override {} // OSG draws cameras, see RasterizedParts
    void apply(osg::Projection&) override {}

    void apply(osg::Transform& node) override
    {
        if (isCulled(node)) return;
        pushCurrentMask();
        osg::ref_ptr<osg::RefMatrix> matrix = new osg::RefMatrix(*getModelViewMatrix());
        node.computeLocalToWorldMatrix(*matrix, this);
        pushModelViewMatrix(matrix.get(), node.getReferenceFrame());
        traverseAs(NODE_VISITOR, node);
        popModelViewMatrix();
        popCurrentMask();
    }

    osg::CullStack* asCullStack() override { return this; }
    const osg::CullStack* asCullStack() const override { return this; }

    osg::Vec3 getEyePoint() const override { return getEyeLocal(); }
    osg::Vec3 getViewPoint() const override { return getViewPointLocal(); }
    float getDistanceToEyePoint(const osg::Vec3& position, bool useLodScale) const override
    {
        return (position - getEyeLocal()).length() * (useLodScale ? getLODScale() : 1.0f);
    }
    float getDistanceToViewPoint(const osg::Vec3& position, bool useLodScale) const override
    {
        return (position - getViewPointLocal()).length() * (useLodScale ? getLODScale() : 1.0f);
    }

private:
    void enter(osg::Node& node, VisitorType type)
    {
        if (isCulled(node)) return;
        pushCurrentMask();
        traverseAs(type, node);
        popCurrentMask();
    }

    /// Traverses groups. Leaves have no pages, and a tile of a terrain makes its geometry when it
    /// is traversed.
    void traverseAs(VisitorType type, osg::Node& node)
    {
        if (!node.asGroup() || std::strcmp(node.className(), "TerrainTile") == 0) return;
        if (!_budget.take()) return;
        const VisitorType outer = getVisitorType();
        setVisitorType(type);
        traverse(node);
        setVisitorType(outer);
    }

    PathBudget _budget;
};

} // namespace

void requestPages(osg::Group& scene, osgUtil::CullVisitor& visitor)
{
    if (!visitor.getViewport() || !visitor.getProjectionMatrix()) return;
    PageVisitor pages(visitor);
    for (unsigned int i = 0; i < scene.getNumChildren(); ++i)
        if (const osg::ref_ptr<osg::Node> child = scene.getChild(i)) child->accept(pages);
}

} // namespace osgRayTrace::engine
