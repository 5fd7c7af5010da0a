// LightGrid.cpp - the sample points of area lights in one pass. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/LightGrid.h"

#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/sampling/LightPoints.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

OSGRAYTRACE_KERNEL
void lightPoints(LightSampling strategy, uint32_t j, uint32_t n, uint32_t samples,
                 uint32_t passIndex, uint32_t dimension, const UintLanes& seeds, FloatLanes& u,
                 FloatLanes& v)
{
    switch (strategy)
    {
    case LightSampling::Random:
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            random2(passIndex * samples + j, dimensionSeed(seeds[i], dimension), u[i], v[i]);
        return;
    case LightSampling::UniformJitter:
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            uniformJitter2(j, n, passIndex, dimensionSeed(seeds[i], dimension), u[i], v[i]);
        return;
    case LightSampling::Stratified:
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            stratified2(j, n, passIndex, dimensionSeed(seeds[i], dimension), u[i], v[i]);
        return;
    case LightSampling::Sobol:
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            sobol2(passIndex * samples + j, dimensionSeed(seeds[i], dimension), u[i], v[i]);
        return;
    }
}

} // namespace

LightGrid::LightGrid(const PassContext& context, std::size_t lights)
    : _strategy(context.options.lightSampling),
      _samples(static_cast<uint32_t>(samplesOfEach(context.options, lights))),
      _side(static_cast<uint32_t>(std::lround(std::sqrt(static_cast<float>(_samples))))),
      _passIndex(context.key.index)
{
}

void LightGrid::draw(std::size_t light, uint32_t j, const UintLanes& seeds, FloatLanes& u,
                     FloatLanes& v) const
{
    const uint32_t dimension = bounceDimension(static_cast<int>(light), DimensionLightPoint);
    lightPoints(_strategy, j, _side, _samples, _passIndex, dimension, seeds, u, v);
}

} // namespace osgRayTrace::engine
