// SurfaceInputs.h - what of a geometry decides on its material. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <osg/Geometry>

namespace osgRayTrace::engine
{

/// The inputs are the parts of a geometry that decide on its material.
struct SurfaceInputs
{
    bool hasVertexColors = false;       ///< colours that vary over the geometry
    bool hasOverallColor = false;       ///< one colour for the whole geometry
    Vec4 overallColor{1.0f};            ///< colour as OpenGL gets it, not decoded
    bool hasTextureCoordinates = false; ///< coordinates of unit 0
    bool hasSecondCoordinates = false;  ///< coordinates of unit 1
    bool hasTangents = false;           ///< vertex attribute 6
    bool isOfSolids = false; ///< points and lines alone, traced as solids: lit in any state
};

/// pointRadius: that of RayTraceSettings.
SurfaceInputs surfaceInputs(const osg::Geometry& geometry, float pointRadius);

} // namespace osgRayTrace::engine
