// ConversionInput.h - the inputs for converting a scene graph. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/lights/LightSizes.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"
#include "osgRayTrace/bridge/common/CullPass.h"
#include "osgRayTrace/bridge/common/GroundRequest.h"
#include "osgRayTrace/bridge/common/ReferenceView.h"
#include "osgRayTrace/scene/Fog.h"

#include <osgRayTrace/MaterialHook>
#include <osgRayTrace/RayTraceSettings>

#include <osg/Light>
#include <osg/Node>
#include <osg/StateSet>
#include <osg/Vec3d>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds the settings that a conversion depends on.
struct ConversionSettings
{
    RayTraceSettings::ColorRule colorRule = RayTraceSettings::AUTOMATIC_COLOR;
    bool cullAllRays = false;
    bool headlightShadows = false;
    FogUse fogUse = FogUse::Depth;
    GroundRequest ground;
    LightSizes lightSizes;
    float pointRadius = 0.0f;                         ///< see RayTraceSettings
    std::shared_ptr<const MaterialLibrary> materials; ///< null: materials of the graph only
    osg::ref_ptr<MaterialHook> hook;                  ///< null: the application is not asked

    /// Returns whether materials depend on more than the state of the graph.
    bool assignsMaterials() const { return materials || hook; }

    bool operator==(const ConversionSettings& other) const
    {
        return colorRule == other.colorRule && cullAllRays == other.cullAllRays &&
               headlightShadows == other.headlightShadows && fogUse == other.fogUse &&
               ground == other.ground && lightSizes == other.lightSizes &&
               pointRadius == other.pointRadius && materials == other.materials &&
               hook == other.hook;
    }
};

inline FogUse fogUseOf(RayTraceSettings::Fog fog)
{
    if (fog == RayTraceSettings::MEDIUM_FOG) return FogUse::Medium;
    return fog == RayTraceSettings::NO_FOG ? FogUse::Off : FogUse::Depth;
}

inline ConversionSettings conversionSettings(const RayTraceSettings& settings,
                                             std::shared_ptr<const MaterialLibrary> materials)
{
    return {settings.getColorRule(),
            settings.getCullAllRays(),
            settings.getHeadlightShadows(),
            fogUseOf(settings.getFog()),
            parseGround(settings.getGround()).value_or(GroundRequest()),
            lightSizesOf(settings),
            settings.getPointRadius(),
            std::move(materials),
            settings.getMaterialHook()};
}

/// Holds the graph to convert and the conditions of the conversion.
struct ConversionInput : ConversionSettings
{
    osg::Node* root = nullptr;
    osg::Vec3d eye; ///< place in world space that decides on levels of detail
    /// View with the same eye, for sizes in pixels and for nodes that turn to the view or move with
    /// it. Without a view, the graph is converted as if looked at from the eye, upright in the
    /// world.
    std::optional<ReferenceView> view;
    /// Cull visitor of the view, for nodes that draw in cull alone; null: such nodes are not run.
    std::shared_ptr<CullPass> pass;
    osg::Vec3d origin; ///< origin of the engine's coordinates in world space
    unsigned int traversalMask = 0xffffffffu;
    std::vector<unsigned int> viewMasks; ///< see ViewingConditions
    /// Light that osgViewer adds outside of the graph, in view space (headlight) or world space
    /// (sky light); null: none. A light of the same number in the graph replaces it.
    osg::ref_ptr<const osg::Light> viewLight;
    bool viewLightInEyeSpace = true;
    bool lighting = true; ///< GL_LIGHTING above the root, off in osg::View's NO_LIGHT mode
    /// State above the root, the outermost first, from a cull traversal; empty: osgViewer's
    /// defaults.
    std::vector<osg::ref_ptr<const osg::StateSet>> inheritedState;
    /// True: OpenGL goes on drawing the parts that it draws better, see
    /// ConversionResult::rasterized. False: there is no OpenGL, and everything with triangles is
    /// traced.
    bool rasterizesRest = false;
    /// True: the conversion makes a ConversionResult::pickIndex to look up hits.
    bool picks = false;
    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f}; ///< display value of the background
};

} // namespace osgRayTrace::engine
