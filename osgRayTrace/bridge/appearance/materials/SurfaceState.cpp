// SurfaceState.cpp - tells what OpenGL's state does to a surface's pixels. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"

#include "osgRayTrace/bridge/common/ClipPlanes.h"

#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/ColorMask>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/Fog>
#include <osg/PolygonMode>
#include <osg/PolygonOffset>
#include <osg/Program>

#include <algorithm>
#include <cmath>
#include <typeinfo>

namespace osgRayTrace::engine
{

Blending blendingOf(const GraphState& state)
{
    if (!state.isOn(kBlendBit)) return Blending::Opaque;
    const auto* blend = state.attribute<osg::BlendFunc>(kBlendFuncSlot);
    if (!blend) return Blending::Straight; // this is osgViewer's default function
    const GLenum source = blend->getSourceRGB(), destination = blend->getDestinationRGB();
    if (destination == GL_ZERO && source == GL_ONE) return Blending::Opaque;
    if (destination == GL_ONE) return Blending::Additive;
    return source == GL_SRC_ALPHA && destination == GL_ONE_MINUS_SRC_ALPHA ? Blending::Straight
                                                                           : Blending::Other;
}

const osg::StateAttribute* programOf(const GraphState& state)
{
    const osg::StateAttribute* attribute = state.attributes[kProgramSlot];
    const auto* program = dynamic_cast<const osg::Program*>(attribute);
    const bool empty =
        program && typeid(*program) == typeid(osg::Program) && program->getNumShaders() == 0;
    if (attribute && !empty) return attribute;
    return state.isOn(kAssemblyProgramBit) ? state.attributes[kAssemblyProgramSlot] : nullptr;
}

bool replacesProgram(const GraphState& state)
{
    return state.attributes[kPhysicalMaterialSlot] && !state.programIsNearer;
}

bool masksColor(const GraphState& state)
{
    const auto* mask = state.attribute<osg::ColorMask>(kColorMaskSlot);
    return mask && !(mask->getRedMask() && mask->getGreenMask() && mask->getBlueMask());
}

bool usesStencil(const GraphState& state)
{
    return state.isOn(kStencilBit) && state.attributes[kStencilSlot];
}

bool hasOneDepth(const GraphState& state)
{
    const auto* depth = state.attribute<osg::Depth>(kDepthSlot);
    return depth && depth->getZNear() == depth->getZFar();
}

float depthBias(const GraphState& state)
{
    constexpr float kMostLayers = 64.0f;
    if (!state.isOn(kPolygonOffsetBit)) return 0.0f;
    const auto* offset = state.attribute<osg::PolygonOffset>(kPolygonOffsetSlot);
    if (!offset) return 0.0f;
    const float units = offset->getUnits() != 0.0f ? offset->getUnits() : offset->getFactor();
    return std::isfinite(units) ? std::clamp(-units, -kMostLayers, kMostLayers) : 0.0f;
}

FaceCulling cullingOf(const GraphState& state)
{
    if (!state.isOn(kCullFaceBit)) return FaceCulling::None;
    const auto* faces = state.attribute<osg::CullFace>(kCullFaceSlot);
    switch (faces ? faces->getMode() : osg::CullFace::BACK)
    {
    case osg::CullFace::FRONT:
        return FaceCulling::Front;
    case osg::CullFace::FRONT_AND_BACK:
        return FaceCulling::FrontAndBack;
    default:
        return FaceCulling::Back;
    }
}

void countApproximations(const GraphState& state, ConversionReport& report)
{
    const bool replaced = programOf(state) && replacesProgram(state);
    if (programOf(state) && !replaced) report.count("approximated.shader");
    if (usesStencil(state)) report.count("approximated.stencil");
    if (masksColor(state)) report.count("approximated.color-mask");
    if (hasOneDepth(state)) report.count("approximated.depth-range");
    if (state.isOn(kLogicOpBit)) report.count("approximated.logic-operation");
    if (state.isOn(kPolygonStippleBit)) report.count("approximated.polygon-stipple");
    const Blending blending = blendingOf(state);
    if (blending == Blending::Additive || blending == Blending::Other)
        report.count("approximated.blending");
    const auto* fog = state.attribute<osg::Fog>(kFogSlot);
    if (fog && state.isOn(kFogBit) && fog->getFogCoordinateSource() == osg::Fog::FOG_COORDINATE)
        report.count("approximated.fog-coordinate");
    const auto* plane = state.attribute<osg::ClipPlane>(kClipPlaneSlot);
    if (plane && plane->getClipPlaneNum() < kClipPlanes &&
        state.isOn(kClipPlaneBit + plane->getClipPlaneNum()))
        report.count("approximated.clip-plane-attribute");
    if (state.usesHigherTextures() && !replaced) report.count("approximated.texture-unit");
    if (const auto* mode = state.attribute<osg::PolygonMode>(kPolygonModeSlot))
        if (mode->getMode(osg::PolygonMode::FRONT) != osg::PolygonMode::FILL ||
            mode->getMode(osg::PolygonMode::BACK) != osg::PolygonMode::FILL)
            report.count("approximated.polygon-mode");
    const FaceCulling culling = cullingOf(state);
    const bool backIsSeen = culling == FaceCulling::None || culling == FaceCulling::Front;
    if (depthBias(state) != 0.0f && backIsSeen)
        report.count("approximated.polygon-offset"); // the bias is right from the front only
}

} // namespace osgRayTrace::engine
