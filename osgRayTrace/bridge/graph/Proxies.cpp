// Proxies.cpp - tells which drawn surfaces have a proxy, and how proxies look. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/Proxies.h"

#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osg/Camera>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/Transform>

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Follows the depth test and the render bins down a path. Nested bins are drawn with the bin
/// around them, so the lowest number counts.
struct DrawOrder
{
    unsigned int testValue = osg::StateAttribute::ON; ///< value of the mode GL_DEPTH_TEST
    int lowestBin = 0;

    void apply(const osg::StateSet& stateSet)
    {
        if (stateSet.useRenderBinDetails())
            lowestBin = std::min(lowestBin, stateSet.getBinNumber());
        const auto test = stateSet.getModeList().find(GL_DEPTH_TEST);
        if (test == stateSet.getModeList().end()) return;
        const bool replaces = !(testValue & osg::StateAttribute::OVERRIDE) ||
                              (test->second & osg::StateAttribute::PROTECTED);
        if (replaces) testValue = test->second;
    }
};

/// Returns whether OSG draws as it draws a surface: nearer ones hide it, and it hides those behind.
/// Skies are drawn behind everything, overlays before it, and passes over other surfaces test for
/// equal depth.
bool isDrawnAsSurface(const DrawOrder& order, const GraphState& state)
{
    if (order.lowestBin < 0 || !(order.testValue & osg::StateAttribute::ON)) return false;
    const auto* depth = state.attribute<osg::Depth>(kDepthSlot);
    if (!depth) return true;
    switch (depth->getFunction())
    {
    case osg::Depth::NEVER:
    case osg::Depth::EQUAL:
    case osg::Depth::ALWAYS:
        return false;
    default:
        break;
    }
    return depth->getWriteMask() && !hasOneDepth(state);
}

/// Returns whether all nodes of the path are placed in the scene, and drawn as its surfaces are.
bool isOfTheScene(const osg::NodePath& path,
                  const std::vector<osg::ref_ptr<const osg::StateSet>>& pushed,
                  const GraphState& state)
{
    DrawOrder order;
    for (const osg::Node* node : path)
    {
        const osg::Transform* transform = node->asTransform();
        const bool isViewer = node == path.front() && node->asCamera();
        if (transform && !isViewer && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF)
            return false;
        if (node->getStateSet()) order.apply(*node->getStateSet());
    }
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : pushed)
        order.apply(*stateSet);
    return isDrawnAsSurface(order, state);
}

/// Returns whether a program may place the vertices elsewhere: in each instance of an instanced
/// draw, or anywhere at all if OSG must not cull the drawable by its bound.
bool isPlacedByProgram(const osg::Drawable& drawable)
{
    if (!drawable.getCullingActive()) return true;
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry) return false;
    const osg::Geometry::PrimitiveSetList& sets = geometry->getPrimitiveSetList();
    return std::any_of(sets.begin(), sets.end(),
                       [](const osg::ref_ptr<osg::PrimitiveSet>& set)
                       { return set && set->getNumInstances() > 1; });
}

/// Returns whether only the inside of a surface is drawn, as of skies, and of hulls around objects
/// whose rim is their outline: such a surface would keep the light off what is in it.
bool showsInside(const GraphState& state)
{
    const FaceCulling culling = cullingOf(state);
    return culling == FaceCulling::Front || culling == FaceCulling::FrontAndBack;
}

/// Returns the state without what makes colours alone: programs, textures and their environments.
GraphState withoutColors(GraphState state)
{
    state.attributes[kProgramSlot] = state.attributes[kAssemblyProgramSlot] = nullptr;
    for (unsigned int unit = 0; unit < kUnits; ++unit)
        for (const UnitSlot slot : {kTextureSlot, kTextureEnvironmentSlot})
            state.attributes[kUnitSlot + unit * kUnitSlots + slot] = nullptr;
    return state;
}

} // namespace

bool hasProxy(const osg::Drawable& drawable, const osg::NodePath& path,
              const std::vector<osg::ref_ptr<const osg::StateSet>>& pushed, const GraphState& state,
              const TextureConverter& textures)
{
    if (hintOf(path) == DrawHint::RasterizeOnly || !isOfTheScene(path, pushed, state)) return false;
    if (programOf(state) && (isPlacedByProgram(drawable) || showsInside(state))) return false;
    if (!rasterizedState(state, textures, nullptr)) return true; // it could be traced as it is
    return blendingOf(state) == Blending::Opaque &&
           !rasterizedState(withoutColors(state), textures, nullptr);
}

GraphState proxyState(const GraphState& state)
{
    GraphState lit = state;
    if (programOf(state)) lit.modesOn |= uint64_t(1) << kLightingBit;
    return lit;
}

void hideFromCamera(Material& material)
{
    material.culling = FaceCulling::FrontAndBack;
    material.cullsAllRays = false;
}

} // namespace osgRayTrace::engine
