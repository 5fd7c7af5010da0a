// CullCapture.cpp - runs a cull visitor over a node. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/CullCapture.h"

#include <osg/GraphicsContext>
#include <osg/Transform>

#include <exception>
#include <new>

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

/// Has a pass's cull visitor fill a stage without culling, and lets go of everything at the end.
class Traversal
{
public:
    Traversal(CullPass& pass, osgUtil::RenderStage& stage, osgUtil::StateGraph& graph)
        : _visitor(pass.visitor), _stage(stage), _graph(graph)
    {
        osg::ref_ptr<osg::Camera> camera;
        osg::ref_ptr<osg::View> view;
        pass.camera.lock(camera);
        pass.view.lock(view);
        _stage.setCamera(camera.get());
        _visitor->reset();
        _visitor->getNodePath().clear();
        _visitor->setFrameStamp(pass.frameStamp.get());
        if (pass.frameStamp) _visitor->setTraversalNumber(pass.frameStamp->getFrameNumber());
        _visitor->setInheritanceMask(0);
        _visitor->setCullingMode(osg::CullSettings::NO_CULLING);
        _visitor->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        // The state is not observed by the pass: draw threads may do so at the same time.
        osg::GraphicsContext* context = camera ? camera->getGraphicsContext() : nullptr;
        osg::RenderInfo renderInfo(context ? context->getState() : nullptr, view.get());
        if (camera) renderInfo.pushCamera(camera.get());
        _visitor->setRenderInfo(renderInfo);
        _visitor->setStateGraph(&_graph);
        _visitor->setRenderStage(&_stage);
    }

    ~Traversal()
    {
        _visitor->reset();
        _visitor->getNodePath().clear();
        _visitor->setStateGraph(nullptr);
        _visitor->setRenderStage(nullptr);
        osg::RenderInfo none;
        _visitor->setRenderInfo(none);
        _stage.reset();
        _stage.setCamera(nullptr);
        _graph.reset();
    }

private:
    const osg::ref_ptr<osgUtil::CullVisitor> _visitor; // the pass may get another one meanwhile
    osgUtil::RenderStage& _stage;
    osgUtil::StateGraph& _graph;
};

} // namespace

CullCapture::CullCapture(CullPass& pass, const ReferenceView& view, unsigned int traversalMask)
    : _pass(pass),
      _view(view),
      _traversalMask(traversalMask),
      _projection(new osg::RefMatrix(view.projection)),
      _viewFromWorld(new osg::RefMatrix(view.viewFromWorld)),
      _viewport(new osg::Viewport(0.0, 0.0, view.width, view.height)),
      _stage(new osgUtil::RenderStage),
      _graph(new osgUtil::StateGraph)
{
}

bool isCapturing()
{
    return captures > 0;
}

template <class Visit>
bool CullCapture::run(const osg::NodePath& path, const osg::Matrixd& worldFromParent,
                      const Visit& visit, CullRecord& record,
                      const CullRecord::SameState& sameState)
{
    const Capturing capturing;
    const Traversal traversal(_pass, *_stage, *_graph);
    osgUtil::CullVisitor& visitor = *_pass.visitor;
    try
    {
        visitor.setTraversalMask(_traversalMask);
        visitor.setLODScale(_view.lodScale);
        _stage->setViewport(_viewport.get());
        _stage->setInitialViewMatrix(_viewFromWorld.get());
        visitor.pushViewport(_viewport.get());
        visitor.pushProjectionMatrix(_projection.get());
        visitor.pushModelViewMatrix(new osg::RefMatrix(worldFromParent * _view.viewFromWorld),
                                    osg::Transform::ABSOLUTE_RF);
        visitor.getNodePath().assign(path.begin(), path.end() - 1);
        visit(*path.back(), visitor);
        return record.take(*_stage, _view.viewFromWorld, *_projection, sameState);
    }
    catch (const std::bad_alloc&)
    {
        throw;
    }
    catch (const std::exception& error)
    {
        record.fail(error.what());
    }
    catch (...)
    {
        record.fail("an exception of a class that is not known");
    }
    _pass.visitor = _pass.visitor->clone(); // the exception has left it in the middle of something
    return false;
}

bool CullCapture::node(const osg::NodePath& path, const osg::Matrixd& worldFromParent,
                       CullRecord& record, const CullRecord::SameState& sameState)
{
    const auto visit = [](osg::Node& node, osgUtil::CullVisitor& visitor) { node.accept(visitor); };
    return run(path, worldFromParent, visit, record, sameState);
}

CullRecord CullCapture::below(const osg::NodePath& path, const osg::Matrixd& worldFromNode)
{
    CullRecord record;
    run(path, worldFromNode, visitBelow, record, {});
    return record;
}

} // namespace osgRayTrace::engine
