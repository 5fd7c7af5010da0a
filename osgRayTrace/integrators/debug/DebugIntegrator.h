// DebugIntegrator.h - shows what the other integrators work with. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

#include <memory>

namespace osgRayTrace::engine
{

/// A DebugIntegrator shows the debug channel as colours: normals as (n + 1)/2, texture coordinates
/// modulo 1, ids as hashed colours, albedo with emission, or window depth. Dropped samples are
/// shown as white pixels and cost is shown as rays / 64, both of the integrator that AUTOMATIC
/// chooses.
class DebugIntegrator : public Integrator
{
public:
    /// A Factory makes the integrator whose counts the debug integrator shows.
    using Factory = std::unique_ptr<Integrator> (*)(IntegratorKind);

    explicit DebugIntegrator(Factory newIntegrator) : _newIntegrator(newIntegrator) {}

    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;

private:
    void showDiagnostics(const PassContext& context, int left, int bottom,
                         TileResult& result) const;

    Factory _newIntegrator;
};

} // namespace osgRayTrace::engine
