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
    bool hasVertexColors = false; ///< colours that vary over the geometry
    bool hasOverallColor = false; ///< one colour for the whole geometry
    Vec4 overallColor{1.0f};      ///< colour as OpenGL gets it, not decoded
    unsigned int uvSets = 0;      ///< bit n: there are coordinates of texture unit n
    bool hasTangents = false;     ///< vertex attribute 6
    bool isOfSolids = false;      ///< points and lines alone, traced as solids: lit in any state
};

/// pointRadius: that of RayTraceSettings.
SurfaceInputs surfaceInputs(const osg::Geometry& geometry, float pointRadius);

} // namespace osgRayTrace::engine
