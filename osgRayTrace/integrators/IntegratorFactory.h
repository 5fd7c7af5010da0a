// IntegratorFactory.h - makes the integrator of each kind. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"

#include <memory>

namespace osgRayTrace::engine
{

/// Returns an integrator of the kind. Callers choose a kind before: kind is not Automatic.
std::unique_ptr<Integrator> newIntegrator(IntegratorKind kind);

} // namespace osgRayTrace::engine
