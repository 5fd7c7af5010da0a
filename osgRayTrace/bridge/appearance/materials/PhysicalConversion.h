// PhysicalConversion.h - converts a PhysicalMaterial to a Material. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/SurfaceInputs.h"
#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Scene.h"

#include <osgRayTrace/PhysicalMaterial>

namespace osgRayTrace::engine
{

/// Returns the texture units from kFirstMoreUvs on whose coordinates the state's physical material
/// reads: bit n for unit n.
unsigned int moreUvSetsOf(const GraphState& state);

/// Returns the material without what the rest of the state decides on. The overall colour of the
/// inputs is linear. Textures whose unit has no coordinates are left out and counted.
Material physicalMaterial(const PhysicalMaterial& source, const SurfaceInputs& inputs,
                          TextureConverter& textures, ConversionReport& report);

} // namespace osgRayTrace::engine
