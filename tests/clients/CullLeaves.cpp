// CullLeaves.cpp - runs a cull traversal and gathers what its stages have. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/clients/CullLeaves.h"

#include <osg/ColorMask>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

namespace osgRayTrace::test
{

using namespace engine;

namespace
{

/// Returns whether a state keeps every colour out of the picture, as of tests for occlusion.
bool isInvisible(const osgUtil::StateGraph* graph)
{
    for (; graph; graph = graph->_parent)
    {
        const osg::StateSet* states = graph->getStateSet();
        const auto* mask = states ? dynamic_cast<const osg::ColorMask*>(
                                        states->getAttribute(osg::StateAttribute::COLORMASK))
                                  : nullptr;
        if (mask) return !mask->getRedMask() && !mask->getGreenMask() && !mask->getBlueMask();
    }
    return false;
}

void addLeaves(osgUtil::RenderBin& bin, bool ownStage, Leaves& leaves)
{
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        for (const osg::ref_ptr<osgUtil::RenderLeaf>& leaf : graph->_leaves)
            if (leaf->getDrawable() && !isInvisible(graph))
                leaves.push_back({leaf->getDrawable(),
                                  leaf->_modelview ? *leaf->_modelview : osg::Matrixd(), ownStage});
    for (const auto& [number, inner] : bin.getRenderBinList())
        addLeaves(*inner, ownStage, leaves);
}

void addStages(osgUtil::RenderStage& stage, bool own, Leaves& leaves)
{
    addLeaves(stage, own, leaves);
    for (const auto* list : {&stage.getPreRenderList(), &stage.getPostRenderList()})
        for (const auto& [number, inner] : *list)
            addStages(*inner, true, leaves);
}

} // namespace

Leaves leavesOf(const CullPass& pass, const ViewingConditions& conditions,
                const std::function<void(osgUtil::CullVisitor&)>& traverse)
{
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    const osg::ref_ptr<osgUtil::StateGraph> graph = new osgUtil::StateGraph;
    const osg::ref_ptr<osg::Viewport> viewport =
        new osg::Viewport(0, 0, conditions.view->width, conditions.view->height);
    osg::ref_ptr<osg::Camera> camera;
    pass.camera.lock(camera);
    stage->setViewport(viewport.get());
    stage->setCamera(camera.get());
    stage->setInitialViewMatrix(new osg::RefMatrix(conditions.view->viewFromWorld));

    osgUtil::CullVisitor& visitor = *pass.visitor;
    visitor.reset();
    visitor.getNodePath().clear();
    visitor.setFrameStamp(pass.frameStamp.get());
    visitor.setTraversalNumber(pass.frameStamp->getFrameNumber());
    visitor.setTraversalMask(conditions.traversalMask);
    visitor.setInheritanceMask(0);
    visitor.setCullingMode(osg::CullSettings::NO_CULLING);
    visitor.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    visitor.setLODScale(conditions.view->lodScale);
    visitor.setDatabaseRequestHandler(nullptr);
    osg::RenderInfo renderInfo = pass.original->getRenderInfo();
    visitor.setRenderInfo(renderInfo);
    visitor.setStateGraph(graph.get());
    visitor.setRenderStage(stage.get());
    visitor.pushViewport(viewport.get());
    visitor.pushProjectionMatrix(new osg::RefMatrix(conditions.view->projection));
    visitor.pushModelViewMatrix(new osg::RefMatrix(conditions.view->viewFromWorld),
                                osg::Transform::ABSOLUTE_RF);
    traverse(visitor);
    Leaves leaves;
    addStages(*stage, false, leaves);
    return leaves;
}

} // namespace osgRayTrace::test
