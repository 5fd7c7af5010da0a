// PathIntegrator.h - unidirectional path tracing with light sampling. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/Integrator.h"

namespace osgRayTrace::engine
{

/// Next-event estimation, multiple importance sampling and Russian roulette: unbiased up to maxBounces.
class PathIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom, TileResult& result) const override;
};

} // namespace osgRayTrace::engine
