// ConversionInput.h - what a scene graph is converted for. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/lights/LightSizes.h"
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"
#include "osgRayTrace/bridge/common/ReferenceView.h"

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

/// Settings that a conversion depends on.
struct ConversionSettings
{
    RayTraceSettings::ColorRule colorRule = RayTraceSettings::AUTOMATIC_COLOR;
    bool cullAllRays = false;
    bool headlightShadows = false;
    LightSizes lightSizes;
    std::shared_ptr<const MaterialLibrary> materials; ///< null: those of the graph only

    bool operator==(const ConversionSettings& other) const
    {
        return colorRule == other.colorRule && cullAllRays == other.cullAllRays &&
               headlightShadows == other.headlightShadows && lightSizes == other.lightSizes &&
               materials == other.materials;
    }
};

inline ConversionSettings conversionSettings(const RayTraceSettings& settings,
                                             std::shared_ptr<const MaterialLibrary> materials)
{
    return {settings.getColorRule(), settings.getCullAllRays(), settings.getHeadlightShadows(),
            lightSizesOf(settings), std::move(materials)};
}

/// What to convert a graph for.
struct ConversionInput : ConversionSettings
{
    osg::Node* root = nullptr;
    osg::Vec3d eye; ///< world space: levels of detail
    /// With the same eye: sizes in pixels, and what turns to the view or moves with it. Without one
    /// that is as if looked at from the eye, upright in the world.
    std::optional<ReferenceView> view;
    osg::Vec3d origin; ///< of the engine's coordinates, world space
    unsigned int traversalMask = 0xffffffffu;
    /// The light that osgViewer adds outside of the graph; null: none. In view space (headlight) or
    /// world space (sky light). Replaced by a light of the same number in the graph.
    osg::ref_ptr<const osg::Light> viewLight;
    bool viewLightInEyeSpace = true;
    bool lighting = true; ///< GL_LIGHTING above the root: off in osg::View's NO_LIGHT mode
    /// State above the root, the outermost first: of a cull traversal. Empty: osgViewer's defaults.
    std::vector<osg::ref_ptr<const osg::StateSet>> inheritedState;
    /// What OpenGL draws better goes on being drawn by it, see ConversionResult::rasterized. Else
    /// there is no OpenGL, and everything with triangles is traced.
    bool rasterizesRest = false;
    bool picks = false; ///< what rays hit is looked up: see ConversionResult::pickIndex
    osg::Vec4 clearColor{0.2f, 0.2f, 0.4f, 1.0f}; ///< as shown
};

} // namespace osgRayTrace::engine
