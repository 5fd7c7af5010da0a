// EnvironmentStrata.h - an environment as a few distant lights. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/EnvironmentMap.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Holds a part of the sphere with all its light in one direction.
struct EnvironmentStratum
{
    Vec3 direction{0.0f, 0.0f, 1.0f}; ///< unit, towards the stratum
    Vec3 integral{0.0f};              ///< integral of radiance over the stratum's solid angle
};

/// Returns count strata that hold, up to rounding, all light of the image [Agarwal03]. A black
/// image has none; there are fewer only if the light comes from fewer cells than count (see below).
///
/// The strata are those of structured importance sampling, made by hierarchical thresholding
/// [Agarwal03, sect. 3.2]: from layers of radiance between multiples of its standard deviation, six
/// of them, and the connected regions of each layer. A region gets strata in proportion to its
/// importance without any knowledge of the scene, L dw^(1/4), with L its integral and dw its solid
/// angle, at most 0.01 sr: views of the scene farther apart than that are uncorrelated anyway
/// [Agarwal03, sect. 3.1]. Regions are stratified one after the other, brightest layers first, by
/// the farthest point from all before it [Hochbaum85]. Each pixel belongs to the nearest stratum of
/// its region.
///
/// There are deviations from the paper. The direction of a stratum is its mean weighted by
/// luminance, not its centre, so that the sun stays where it is. Images of more than 512 x 256
/// pixels are first brought together to about that, each cell with its own mean direction. Pixels
/// of images below 256 x 128 are cut up to that, because they are patches with a size, not points.
/// A region gets no more strata than it has cells.
std::vector<EnvironmentStratum> environmentStrata(const EnvironmentMap& map, int count);

} // namespace osgRayTrace::engine
