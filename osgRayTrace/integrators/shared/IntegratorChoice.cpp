// IntegratorChoice.cpp - the cheapest integrator that is right for a scene. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"

namespace osgRayTrace::engine
{

IntegratorKind chooseIntegrator(IntegratorKind wanted, const SceneTraits& traits)
{
    // Light that media emit comes with no photons: paths find it, before they look up any.
    if (traits.glowing && photonUse(wanted) == PhotonUse::Indirect) return IntegratorKind::Path;
    if (wanted != IntegratorKind::Automatic) return wanted;
    const bool lights = traits.areaLights || traits.deltaLights || traits.environment;
    const bool caustics = (lights && (traits.specular || traits.transmission)) ||
                          ((traits.areaLights || traits.deltaLights) && traits.glossy);
    if (!traits.scattering && !traits.physical) return IntegratorKind::Whitted;
    return caustics ? IntegratorKind::PhotonCaustics : IntegratorKind::Path;
}

bool photonsAreOptional(IntegratorKind wanted, const SceneTraits& traits)
{
    // A texture may make a part of the metal a mirror, whose light paths cannot find.
    return wanted == IntegratorKind::Automatic && !traits.specular && !traits.transmission &&
           !traits.textures;
}

PhotonUse photonUse(IntegratorKind kind)
{
    switch (kind)
    {
    case IntegratorKind::Ppm:
    case IntegratorKind::Sppm:
        return PhotonUse::Indirect;
    case IntegratorKind::PhotonCaustics:
        return PhotonUse::Caustics;
    default:
        return PhotonUse::None;
    }
}

} // namespace osgRayTrace::engine
