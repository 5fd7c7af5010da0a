// UntracedParts.cpp - finds the parts of a graph that are no surfaces for rays. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/appearance/textures/TextureUnits.h"
#include "osgRayTrace/bridge/common/LibraryName.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/ClipPlane>
#include <osg/PolygonMode>
#include <osgText/TextBase>

#include <cstring>
#include <typeinfo>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether a texture of the material is one that only OpenGL has.
bool looksIntoOpenGL(const PhysicalMaterial& material, const TextureConverter& textures)
{
    for (int use = 0; use < PhysicalMaterial::NUMBER_OF_TEXTURES; ++use)
    {
        const osg::Texture2D* texture =
            material.getTexture(static_cast<PhysicalMaterial::TextureUse>(use));
        if (texture && isOnlyInOpenGL(*texture) && !textures.knows(*texture)) return true;
    }
    return false;
}

} // namespace

const char* untracedDrawable(const osg::Drawable& drawable)
{
    if (dynamic_cast<const osgText::TextBase*>(&drawable)) return "not-traced.text";
    if (isFrom(&drawable, "osgParticle")) return "not-traced.particles";
    if (isFrom(&drawable, "osgRayTrace")) return nullptr;
    return "not-traced.custom-drawable";
}

bool isForTheMouse(const osg::Drawable& drawable)
{
    // The class is in no header; see osgManipulator::setDrawableToAlwaysCull.
    const osg::Callback* callback = drawable.getCullCallback();
    return callback && std::strcmp(typeid(*callback).name(), "17ForceCullCallback") == 0;
}

const char* untracedLeaf(const osg::Node& node)
{
    const bool rainOrSnow = std::strcmp(node.className(), "PrecipitationEffect") == 0;
    if (isFrom(&node, "osgParticle")) return rainOrSnow ? "not-traced.particles" : nullptr;
    return std::strcmp(node.className(), "LightPointNode") == 0 ? "not-traced.light-points"
                                                                : "not-traced.custom-node";
}

const char* untracedCamera(const osg::Camera& camera)
{
    if (camera.getRenderTargetImplementation() != osg::Camera::FRAME_BUFFER ||
        !camera.getBufferAttachmentMap().empty())
        return "not-traced.render-to-texture-camera";
    // Readers of models make such cameras of the models' own: places to look from.
    const bool drawsNothing = camera.getRenderOrder() == osg::Camera::NESTED_RENDER &&
                              camera.getClearMask() == 0 && camera.getNumChildren() == 0;
    if (drawsNothing) return nullptr;
    if (camera.getRenderOrder() != osg::Camera::NESTED_RENDER ||
        camera.getReferenceFrame() != osg::Transform::RELATIVE_RF ||
        !camera.getProjectionMatrix().isIdentity())
        return "not-traced.hud-camera";
    return nullptr;
}

const char* rasterizedState(const GraphState& state, const TextureConverter& textures,
                            const osg::StateAttribute* poses)
{
    const osg::StateAttribute* program = programOf(state);
    const bool replaced = program && replacesProgram(state);
    if (program && program != poses && !replaced) return "rasterized.shader-program";
    if (usesStencil(state)) return "rasterized.stencil";
    if (masksColor(state)) return "rasterized.color-mask";
    if (hasOneDepth(state)) return "rasterized.depth-range";
    if (state.isOn(kLogicOpBit)) return "rasterized.logic-operation";
    if (state.isOn(kPolygonStippleBit)) return "rasterized.polygon-stipple";
    const auto* material = state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot);
    if ((!replaced && looksIntoOpenGL(state, textures)) ||
        (material && looksIntoOpenGL(*material, textures)))
        return "rasterized.texture-without-image";
    const auto* polygons = state.attribute<osg::PolygonMode>(kPolygonModeSlot);
    if (polygons && polygons->getMode(osg::PolygonMode::FRONT) != osg::PolygonMode::FILL)
        return "rasterized.polygon-mode";
    if (!material && combinesTextures(state)) return "rasterized.texture-combine";
    switch (blendingOf(state))
    {
    case Blending::Additive:
        return "rasterized.additive-blending";
    case Blending::Other:
        return "rasterized.blending";
    default:
        break;
    }
    // The plane is in the coordinates of the drawable that happens to be drawn first with it.
    const auto* plane = state.attribute<osg::ClipPlane>(kClipPlaneSlot);
    if (plane && plane->getClipPlaneNum() < kClipPlanes &&
        state.isOn(kClipPlaneBit + plane->getClipPlaneNum()))
        return "rasterized.clip-plane-attribute";
    return nullptr;
}

} // namespace osgRayTrace::engine
