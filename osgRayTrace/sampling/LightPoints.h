// LightPoints.h - the strategies that place samples on an area light. Layer: sampling.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/sampling/Sobol.h"

namespace osgRayTrace::engine
{

/// Sets x and y to independent uniform numbers; the key of each is (seed, index).
OSGRAYTRACE_INLINE void random2(uint32_t index, uint32_t seed, float& x, float& y)
{
    const uint32_t first = hash(seed, index);
    x = unitFloat(first);
    y = unitFloat(hash(first ^ 0x5bd1e995u));
}

/// Sets x and y to sample j of the n x n that a hit takes in one pass, all cells shifted alike
/// [McCarthy17, alg. 1].
OSGRAYTRACE_INLINE void uniformJitter2(uint32_t j, uint32_t n, uint32_t passIndex, uint32_t seed,
                                       float& x, float& y)
{
    const float cell = 1.0f / static_cast<float>(static_cast<int>(n));
    random2(passIndex, seed, x, y);
    x = (static_cast<float>(static_cast<int>(j % n)) + x) * cell;
    y = (static_cast<float>(static_cast<int>(j / n)) + y) * cell;
}

/// Sets x and y to sample j of the n x n that a hit takes in one pass, each cell with its own shift
/// [McCarthy17, alg. 2].
OSGRAYTRACE_INLINE void stratified2(uint32_t j, uint32_t n, uint32_t passIndex, uint32_t seed,
                                    float& x, float& y)
{
    const float cell = 1.0f / static_cast<float>(static_cast<int>(n));
    random2(passIndex * n * n + j, seed, x, y);
    x = (static_cast<float>(static_cast<int>(j % n)) + x) * cell;
    y = (static_cast<float>(static_cast<int>(j / n)) + y) * cell;
}

} // namespace osgRayTrace::engine
