// WhittedIntegrator.h - direct light, shadows, mirrors and glass. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// The recursive ray tracer of [Whitted80] and of [McCarthy17]: fixed-function surfaces are lit by
/// OpenGL's equations with shadows; area lights by lightSamples shadow rays; smooth physical
/// surfaces reflect and refract, along both ways, to maxBounces. Light that diffuse surfaces send
/// each other is left out, and so are reflections of things in rough surfaces.
class WhittedIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
