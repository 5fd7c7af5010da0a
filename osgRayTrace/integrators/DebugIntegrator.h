// DebugIntegrator.h - shows what the other integrators work with. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/Integrator.h"

namespace osgRayTrace::engine
{

/// The debug channel as colours: normals as (n + 1)/2, texture coordinates modulo 1, ids as hashed
/// colours, albedo, window depth; dropped samples as white pixels and cost as rays / 64, both of
/// the integrator that AUTOMATIC chooses.
class DebugIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
