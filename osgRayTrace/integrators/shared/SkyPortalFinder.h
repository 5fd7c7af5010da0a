// SkyPortalFinder.h - finds the openings through which a view's room sees the sky. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/SkyPortals.h"

#include <memory>

namespace osgRayTrace::engine
{

/// Returns rectangles in the openings through which what the view sees gets light of the sky; null
/// if the sky is found by more than one ray of twenty or never, or if few rectangles do not hold
/// most of its rays. Some thousand rays from what the camera sees tell: those that meet the sky are
/// nowhere as dense as in the opening that they all come through. The result depends on the scene
/// and the camera alone, not on seeds. The rays are added to the counts.
std::shared_ptr<const SkyPortals> findSkyPortals(const PassContext& context, TileCounts& counts);

} // namespace osgRayTrace::engine
