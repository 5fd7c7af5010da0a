// BsdfDensity.h - tests whether the samples of a Bsdf have the density that it claims.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine::test
{

/// Holds the results for one surface and direction.
struct DensityResult
{
    double fit = 1.0;            ///< probability of the chi-square test
    double total = 0.0;          ///< integral of the density
    double accepted = 0.0;       ///< share of samples that were not discarded
    double withoutDensity = 0.0; ///< samples in cells of zero density
    int inconsistent = 0;        ///< samples whose density or weight differs from evalBsdf's
    int bad = 0;                 ///< densities that are negative or not finite
};

/// Returns the chi-square test of samples over cells around the mirror and the refracted direction,
/// up to 640 of them, against the integral of the density over each cell.
DensityResult testDensity(const Bsdf& bsdf, Vec3 wo, uint32_t seed, int samples);

} // namespace osgRayTrace::engine::test
