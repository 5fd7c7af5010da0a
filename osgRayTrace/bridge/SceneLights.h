// SceneLights.h - the lights of a Scene, from those of the graph and from what shines. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/ConversionState.h"

namespace osgRayTrace::engine
{

/// Sets all lights of a scene whose instances and materials are complete, and which light an instance is.
/// Counts what is wrong with the sources.
void setLights(Scene& scene, const ConversionInput& input, const LightSources& sources,
               ConversionCaches& caches, ConversionReport& report);

} // namespace osgRayTrace::engine
