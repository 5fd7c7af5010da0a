// IntegratorFactory.h - the table of integrators. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/IntegratorChoice.h"

#include <memory>

namespace osgRayTrace::engine
{

/// kind is not Automatic.
std::unique_ptr<Integrator> newIntegrator(IntegratorKind kind);

} // namespace osgRayTrace::engine
