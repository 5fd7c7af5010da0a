// WhittedIntegrator.h - direct light, shadows, mirrors and glass. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"

namespace osgRayTrace::engine
{

/// The recursive ray tracer of [Whitted80] and of [McCarthy17]. OpenGL's equations with shadows
/// light fixed-function surfaces, and lightSamples shadow rays sample each area light. Smooth
/// physical surfaces reflect and refract; both rays are followed, up to maxBounces. The integrator
/// leaves out the light that diffuse surfaces send each other, and the reflections of things in
/// rough surfaces.
class WhittedIntegrator : public Integrator
{
public:
    void renderTile(const PassContext& context, int left, int bottom,
                    TileResult& result) const override;
};

} // namespace osgRayTrace::engine
