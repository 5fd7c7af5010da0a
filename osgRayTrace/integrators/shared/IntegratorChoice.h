// IntegratorChoice.h - the integrator that a scene needs, and the photons that an integrator needs.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/photons/PhotonUse.h"
#include "osgRayTrace/scene/SceneTraits.h"

namespace osgRayTrace::engine
{

/// Photons that the integrator looks up.
PhotonUse photonUse(IntegratorKind kind);

/// Replaces Automatic by the cheapest integrator that is right for the scene: Whitted for scenes of
/// fixed-function materials, path tracing as soon as a material is physical, with photons for the
/// caustics if something is mirror-like or transmits.
IntegratorKind chooseIntegrator(IntegratorKind wanted, const SceneTraits& traits);

} // namespace osgRayTrace::engine
