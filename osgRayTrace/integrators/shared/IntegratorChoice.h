// IntegratorChoice.h - a scene's integrator, and an integrator's photons. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/photons/PhotonUse.h"
#include "osgRayTrace/scene/SceneTraits.h"

namespace osgRayTrace::engine
{

/// Returns the use of the photons that the integrator looks up.
PhotonUse photonUse(IntegratorKind kind);

/// Returns wanted, or in place of Automatic the cheapest integrator that is right for the scene.
/// Scenes of fixed-function materials get Whitted. Scenes with a physical material get path
/// tracing, with photons for the caustics if there are lights and something is mirror-like or
/// transmits (and is more than the boundary of a medium), or if there are lights other than a sky
/// and some metal is glossy.
IntegratorKind chooseIntegrator(IntegratorKind wanted, const SceneTraits& traits);

/// Returns whether chooseIntegrator took photons for glossy metal alone: all light that they carry
/// could be found by paths as well, if perhaps with much noise.
bool photonsAreOptional(IntegratorKind wanted, const SceneTraits& traits);

} // namespace osgRayTrace::engine
