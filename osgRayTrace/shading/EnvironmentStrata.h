// EnvironmentStrata.h - an environment as a few distant lights, by structured importance sampling.
// Layer: shading. SPDX-License-Identifier: MIT
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

/// At most count of them, fewer if the image has fewer pixels that are not black; together they
/// hold all of its light [Agarwal03].
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
/// that the sun stays where it is; images of more than 512 x 256 pixels are first brought together
/// to that, each with its own mean direction; a region gets no more strata than it has pixels.
std::vector<EnvironmentStratum> environmentStrata(const EnvironmentMap& map, int count);

} // namespace osgRayTrace::engine
