// FixedFunction.h - a material as OpenGL's fixed function shows it. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/GltfSurface.h"
#include "osgPlugins/gltf/MaterialValues.h"

namespace osgRayTrace::gltf
{

/// Sets osg::Material, textures, blending, alpha test and culling.
void setFixedFunction(const MaterialValues& values, const SurfaceUse& use, Surface& surface);

} // namespace osgRayTrace::gltf
