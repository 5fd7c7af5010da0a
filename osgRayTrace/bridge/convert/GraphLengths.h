// GraphLengths.h - finds the lengths of a collected graph and applies its unit. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/graph/CollectedGraph.h"

namespace osgRayTrace::engine
{

/// Returns the lengths of all that is traced, as long as the graph is in units of the world.
LengthCounts lengthsOf(const CollectedGraph& graph);

/// Puts all matrices into units of Scene::unit. The collector knows the origin of engine space, but
/// not its unit yet: it leaves lengths as they are in the world.
void applyUnit(double unit, CollectedGraph& graph);

} // namespace osgRayTrace::engine
