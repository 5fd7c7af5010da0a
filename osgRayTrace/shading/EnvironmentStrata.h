// EnvironmentStrata.h - an environment as a few distant lights, by structured importance sampling.
// Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/EnvironmentMap.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A part of the sphere with all its light in one direction.
struct EnvironmentStratum
{
    Vec3 direction{0.0f, 0.0f, 1.0f}; ///< unit, towards it
    Vec3 integral{0.0f};              ///< of radiance over its solid angle
};

/// count of them, up to rounding all light of the image [Agarwal03]. None of a black one; fewer
/// only if the light comes from fewer cells than that (see below).
///
/// Hierarchical thresholding [Agarwal03, sect. 3.2]: layers of radiance between multiples of its
/// standard deviation, six of them, and the connected regions of each. A region gets strata in
/// proportion to its importance without any knowledge of the scene, L dw^(1/4) with L its integral
/// and dw its solid angle, at most 0.01 sr: what greater ones see of the scene is uncorrelated
/// anyway [Agarwal03, sect. 3.1]. Stratification within a region, brightest layers first, by the
/// farthest point from all before it [Hochbaum85]; each pixel belongs to the nearest one of its
/// region.
///
/// Deviations: the direction is the mean over a stratum, weighted by luminance, not its centre, so
/// that the sun stays where it is. Images of more than 512 x 256 pixels are first brought together
/// to about that, each cell with its own mean direction, and pixels of images below 256 x 128 are
/// cut up to that: they are patches with a size, not points. A region gets no more strata than it
/// has cells.
std::vector<EnvironmentStratum> environmentStrata(const EnvironmentMap& map, int count);

} // namespace osgRayTrace::engine
