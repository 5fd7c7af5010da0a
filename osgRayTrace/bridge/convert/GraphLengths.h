// GraphLengths.h - the lengths of what was collected, and the unit that they are put into. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

namespace osgRayTrace::engine
{

/// The lengths of all that is traced, as long as the graph is in units of the world.
LengthCounts lengthsOf(const CollectedGraph& graph);

/// The collector knows the origin of engine space, but not its unit yet: it leaves lengths as they
/// are in the world. This puts all matrices into units of Scene::unit.
void applyUnit(double unit, CollectedGraph& graph);

} // namespace osgRayTrace::engine
