// Integrator.cpp - the table of integrators. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/Integrator.h"

#include "osgRayTrace/integrators/DebugIntegrator.h"
#include "osgRayTrace/integrators/PathIntegrator.h"
#include "osgRayTrace/integrators/WhittedIntegrator.h"

namespace osgRayTrace::engine
{

std::unique_ptr<Integrator> newIntegrator(IntegratorKind kind)
{
    switch (kind)
    {
    case IntegratorKind::Automatic:
    case IntegratorKind::Whitted:
        return std::make_unique<WhittedIntegrator>();
    case IntegratorKind::Path:
    case IntegratorKind::Ppm:
    case IntegratorKind::Sppm:
    case IntegratorKind::PhotonCaustics:
        return std::make_unique<PathIntegrator>();
    case IntegratorKind::Debug:
        return std::make_unique<DebugIntegrator>();
    }
    return nullptr;
}

IntegratorKind chooseIntegrator(IntegratorKind wanted, const SceneTraits& traits)
{
    if (wanted != IntegratorKind::Automatic) return wanted;
    if (!traits.physical) return IntegratorKind::Whitted;
    const bool lights = traits.areaLights || traits.deltaLights || traits.environment;
    const bool caustics = lights && (traits.specular || traits.transmission);
    return caustics ? IntegratorKind::PhotonCaustics : IntegratorKind::Path;
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
