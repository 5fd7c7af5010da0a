// CullCapture.cpp - runs a cull visitor and reads its state graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/CullCapture.h"

#include <osg/GraphicsContext>
#include <osg/Transform>
#include <osg/Viewport>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

thread_local int captures = 0;

struct Capturing
{
    Capturing() { ++captures; }
    ~Capturing() { --captures; }
};

/// Finds the nodes that a traversal meets directly below a node, at the place where the cull
/// visitor is.
class ChildFinder : public osg::NodeVisitor
{
public:
    explicit ChildFinder(osgUtil::CullVisitor& visitor)
        : osg::NodeVisitor(NODE_VISITOR, TRAVERSE_ACTIVE_CHILDREN), _visitor(visitor)
    {
        setTraversalMask(visitor.getTraversalMask());
        setFrameStamp(const_cast<osg::FrameStamp*>(visitor.getFrameStamp()));
        setTraversalNumber(visitor.getTraversalNumber());
    }

    using osg::NodeVisitor::apply;
    void apply(osg::Node& node) override { found.push_back(&node); }
    osg::CullStack* asCullStack() override { return &_visitor; }
    const osg::CullStack* asCullStack() const override { return &_visitor; }
    osg::Vec3 getEyePoint() const override { return _visitor.getEyePoint(); }
    osg::Vec3 getViewPoint() const override { return _visitor.getViewPoint(); }
    float getDistanceToEyePoint(const osg::Vec3& point, bool useLodScale) const override
    {
        return _visitor.getDistanceToEyePoint(point, useLodScale);
    }
    float getDistanceFromEyePoint(const osg::Vec3& point, bool useLodScale) const override
    {
        return _visitor.getDistanceFromEyePoint(point, useLodScale);
    }
    float getDistanceToViewPoint(const osg::Vec3& point, bool useLodScale) const override
    {
        return _visitor.getDistanceToViewPoint(point, useLodScale);
    }

    std::vector<osg::ref_ptr<osg::Node>> found;

private:
    osgUtil::CullVisitor& _visitor;
};

void visitBelow(osg::Node& node, osgUtil::CullVisitor& visitor)
{
    visitor.pushOntoNodePath(&node);
    if (const osg::StateSet* stateSet = node.getStateSet()) visitor.pushStateSet(stateSet);
    ChildFinder finder(visitor);
    node.traverse(finder);
    for (const osg::ref_ptr<osg::Node>& child : finder.found)
        child->accept(visitor);
    if (node.getStateSet()) visitor.popStateSet();
    visitor.popFromNodePath();
}

struct OrderedLeaf
{
    const osgUtil::RenderLeaf* leaf = nullptr;
    const osgUtil::StateGraph* graph = nullptr;
};

void addLeaves(osgUtil::RenderBin& bin, std::vector<OrderedLeaf>& leaves)
{
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        for (const osg::ref_ptr<osgUtil::RenderLeaf>& leaf : graph->_leaves)
            if (leaf->getDrawable()) leaves.push_back({leaf.get(), graph});
    for (const auto& [number, inner] : bin.getRenderBinList())
        addLeaves(*inner, leaves);
}

/// projection: that of the view.
std::vector<CapturedLeaf> leavesOf(osgUtil::RenderStage& stage, const osg::Matrixd& worldFromView,
                                   const osg::RefMatrix& projection)
{
    std::vector<OrderedLeaf> ordered;
    addLeaves(stage, ordered);
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const OrderedLeaf& a, const OrderedLeaf& b)
                     { return a.leaf->_traversalOrderNumber < b.leaf->_traversalOrderNumber; });
    std::vector<CapturedLeaf> leaves;
    for (const OrderedLeaf& entry : ordered)
    {
        CapturedLeaf& leaf = leaves.emplace_back();
        leaf.drawable = const_cast<osg::Drawable*>(entry.leaf->getDrawable());
        if (entry.leaf->_modelview) leaf.worldFromLocal = *entry.leaf->_modelview;
        leaf.worldFromLocal.postMult(worldFromView);
        leaf.isProjected = entry.leaf->_projection != &projection;
        for (const osgUtil::StateGraph* graph = entry.graph; graph; graph = graph->_parent)
            if (graph->getStateSet()) leaf.states.push_back(graph->getStateSet());
        std::reverse(leaf.states.begin(), leaf.states.end());
    }
    return leaves;
}

/// Sets a cull visitor up for a traversal that culls nothing, and lets go of everything at the end.
class Setup
{
public:
    Setup(CullPass& pass, const ReferenceView& view, unsigned int traversalMask)
        : stage(new osgUtil::RenderStage),
          graph(new osgUtil::StateGraph),
          projection(new osg::RefMatrix(view.projection)),
          _visitor(pass.visitor)
    {
        osg::ref_ptr<osg::Camera> camera;
        osg::ref_ptr<osg::View> osgView;
        pass.camera.lock(camera);
        pass.view.lock(osgView);
        const osg::ref_ptr<osg::Viewport> viewport =
            new osg::Viewport(0.0, 0.0, view.width, view.height);
        stage->setViewport(viewport.get());
        stage->setCamera(camera.get());
        stage->setInitialViewMatrix(new osg::RefMatrix(view.viewFromWorld));

        _visitor->reset();
        _visitor->getNodePath().clear();
        _visitor->setFrameStamp(pass.frameStamp.get());
        if (pass.frameStamp) _visitor->setTraversalNumber(pass.frameStamp->getFrameNumber());
        _visitor->setTraversalMask(traversalMask);
        _visitor->setInheritanceMask(0);
        _visitor->setCullingMode(osg::CullSettings::NO_CULLING);
        _visitor->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        _visitor->setLODScale(view.lodScale);
        // The state is not observed by the pass: draw threads may do so at the same time.
        osg::GraphicsContext* context = camera ? camera->getGraphicsContext() : nullptr;
        osg::RenderInfo renderInfo(context ? context->getState() : nullptr, osgView.get());
        if (camera) renderInfo.pushCamera(camera.get());
        _visitor->setRenderInfo(renderInfo);
        _visitor->setStateGraph(graph.get());
        _visitor->setRenderStage(stage.get());
        _visitor->pushViewport(viewport.get());
        _visitor->pushProjectionMatrix(projection.get());
    }

    ~Setup()
    {
        _visitor->reset();
        _visitor->getNodePath().clear();
        _visitor->setStateGraph(nullptr);
        _visitor->setRenderStage(nullptr);
        osg::RenderInfo none;
        _visitor->setRenderInfo(none);
    }

    const osg::ref_ptr<osgUtil::RenderStage> stage;
    const osg::ref_ptr<osgUtil::StateGraph> graph;
    const osg::ref_ptr<osg::RefMatrix> projection;

private:
    const osg::ref_ptr<osgUtil::CullVisitor> _visitor; // the pass may get another one meanwhile
};

} // namespace

bool isCapturing()
{
    return captures > 0;
}

template <class Visit>
CapturedContent CullCapture::run(const osg::NodePath& path, const osg::Matrixd& worldFromParent,
                                 const Visit& visit) const
{
    const Capturing capturing;
    const Setup setup(_pass, _view, _traversalMask);
    osgUtil::CullVisitor& visitor = *_pass.visitor;
    CapturedContent content;
    try
    {
        visitor.pushModelViewMatrix(new osg::RefMatrix(worldFromParent * _view.viewFromWorld),
                                    osg::Transform::ABSOLUTE_RF);
        visitor.getNodePath().assign(path.begin(), path.end() - 1);
        visit(*path.back(), visitor);
        content.leaves =
            leavesOf(*setup.stage, osg::Matrixd::inverse(_view.viewFromWorld), *setup.projection);
        content.otherStages =
            !setup.stage->getPreRenderList().empty() || !setup.stage->getPostRenderList().empty();
    }
    catch (const std::bad_alloc&)
    {
        throw;
    }
    catch (const std::exception& error)
    {
        content.error = error.what();
    }
    catch (...)
    {
        content.error = "an exception of a class that is not known";
    }
    if (content.error.empty()) return content;
    // The exception has left the visitor in the middle of something.
    content.leaves.clear();
    _pass.visitor = _pass.visitor->clone();
    return content;
}

CapturedContent CullCapture::node(const osg::NodePath& path,
                                  const osg::Matrixd& worldFromParent) const
{
    return run(path, worldFromParent,
               [](osg::Node& node, osgUtil::CullVisitor& visitor) { node.accept(visitor); });
}

CapturedContent CullCapture::below(const osg::NodePath& path,
                                   const osg::Matrixd& worldFromNode) const
{
    return run(path, worldFromNode, visitBelow);
}

} // namespace osgRayTrace::engine
