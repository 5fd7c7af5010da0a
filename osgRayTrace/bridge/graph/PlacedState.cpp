// PlacedState.cpp - gives positional state to a cull visitor. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/PlacedState.h"

#include <osg/ClearNode>
#include <osg/ClipNode>
#include <osg/LightSource>
#include <osg/TexGenNode>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

namespace osgRayTrace::engine
{

void placeState(const osg::Node& node, osgUtil::CullVisitor& visitor)
{
    osg::RefMatrix* matrix = visitor.getModelViewMatrix();
    if (const auto* source = dynamic_cast<const osg::LightSource*>(&node))
    {
        const bool inEyeSpace = source->getReferenceFrame() == osg::LightSource::ABSOLUTE_RF;
        if (source->getLight())
            visitor.addPositionedAttribute(inEyeSpace ? nullptr : matrix, source->getLight());
    }
    else if (const auto* clip = dynamic_cast<const osg::ClipNode*>(&node))
    {
        const bool inEyeSpace = clip->getReferenceFrame() == osg::ClipNode::ABSOLUTE_RF;
        for (const osg::ref_ptr<osg::ClipPlane>& plane : clip->getClipPlaneList())
            visitor.addPositionedAttribute(inEyeSpace ? nullptr : matrix, plane.get());
    }
    else if (const auto* texGen = dynamic_cast<const osg::TexGenNode*>(&node))
    {
        const bool inEyeSpace = texGen->getReferenceFrame() == osg::TexGenNode::ABSOLUTE_RF;
        if (texGen->getTexGen())
            visitor.addPositionedTextureAttribute(
                texGen->getTextureUnit(), inEyeSpace ? nullptr : matrix, texGen->getTexGen());
    }
    else if (const auto* clear = dynamic_cast<const osg::ClearNode*>(&node))
    {
        osgUtil::RenderStage* stage = visitor.getCurrentRenderBin()->getStage();
        if (clear->getRequiresClear()) stage->setClearColor(clear->getClearColor());
        // A sky that clears by its own Depth leaves the depth buffer as it was if it is traced.
        stage->setClearMask(clear->getRequiresClear() ? clear->getClearMask()
                                                      : GL_DEPTH_BUFFER_BIT);
    }
}

} // namespace osgRayTrace::engine
