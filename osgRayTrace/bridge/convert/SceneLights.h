// SceneLights.h - the lights of a Scene, from those of the graph and from what shines. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/convert/ConversionState.h"

namespace osgRayTrace::engine
{

/// Sets all lights of a scene whose instances and materials are complete, and which light an
/// instance is. Counts what is wrong with the sources, and the viewer's own light.
void setLights(Scene& scene, const ConversionInput& input, const LightSources& sources,
               ConversionCaches& caches, ConversionReport& report);

/// How many of the lights are the viewer's own and not the graph's, by the counts of setLights: 0
/// or 1.
uint64_t viewerLights(const ConversionCounts& counts);

} // namespace osgRayTrace::engine
