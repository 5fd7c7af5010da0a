// IntegratorFactory.cpp - makes the integrator of each kind. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/IntegratorFactory.h"

#include "osgRayTrace/integrators/debug/DebugIntegrator.h"
#include "osgRayTrace/integrators/path/PathIntegrator.h"
#include "osgRayTrace/integrators/whitted/WhittedIntegrator.h"

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
        return std::make_unique<DebugIntegrator>(newIntegrator);
    }
    return nullptr;
}

} // namespace osgRayTrace::engine
