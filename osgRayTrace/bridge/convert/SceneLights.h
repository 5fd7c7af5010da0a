// SceneLights.h - sets the lights of a Scene from those of the graph and from emitting surfaces.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/convert/ConversionState.h"

namespace osgRayTrace::engine
{

/// Sets all lights of a scene whose instances and materials are complete, and the light that an
/// instance is. Counts the faults of the sources, and the viewer's own light.
void setLights(Scene& scene, const ConversionInput& input, const LightSources& sources,
               ConversionCaches& caches, ConversionReport& report);

/// Returns how many of the lights are the viewer's own and not the graph's, by the counts of
/// setLights: 0 or 1.
uint64_t viewerLights(const ConversionCounts& counts);

} // namespace osgRayTrace::engine
