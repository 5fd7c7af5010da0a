// LightGrid.cpp - the sample points of area lights in one pass. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/LightGrid.h"

#include "osgRayTrace/sampling/LightPoints.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

OSGRAYTRACE_KERNEL
void lightPoints(const LightGridLayout& grid, uint32_t j, uint32_t dimension,
                 const UintLanes& seeds, FloatLanes& u, FloatLanes& v)
{
    const uint32_t n = grid.side, samples = grid.samples, passIndex = grid.passIndex;
    switch (grid.strategy)
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

LightGrid::LightGrid(const PassContext& context, int samples)
{
    const auto side = std::lround(std::sqrt(static_cast<float>(samples)));
    _layout = {context.options.lightSampling, static_cast<uint32_t>(samples),
               static_cast<uint32_t>(side), context.key.index};
}

void LightGrid::draw(std::size_t light, uint32_t j, const UintLanes& seeds, FloatLanes& u,
                     FloatLanes& v) const
{
    const uint32_t dimension = bounceDimension(static_cast<int>(light), DimensionLightPoint);
    lightPoints(_layout, j, dimension, seeds, u, v);
}

} // namespace osgRayTrace::engine
