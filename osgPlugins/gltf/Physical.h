// Physical.h - a material as the ray tracer's PhysicalMaterial. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/MaterialValues.h"

#include <osgRayTrace/PhysicalMaterial>

namespace osgRayTrace::gltf
{

osg::ref_ptr<PhysicalMaterial> physicalMaterial(const MaterialValues& values, bool vertexColors);

} // namespace osgRayTrace::gltf
