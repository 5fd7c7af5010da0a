// GraphTraits.h - what all surfaces of a collected graph together decide for each of them. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/graph/CollectedGraph.h"

#include <osgRayTrace/RayTraceSettings>

namespace osgRayTrace::engine
{

/// Returns whether colours are linear: by the rule, or because something in the graph is physical.
bool isLinear(const CollectedGraph& graph, RayTraceSettings::ColorRule rule);

/// Returns whether a material makes another colour current, see MaterialRules.
bool setsColor(const CollectedGraph& graph);

} // namespace osgRayTrace::engine
