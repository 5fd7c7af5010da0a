// VolumePhotons.h - the photons of a pass within media, and how their kernels shrink. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/BeamMap.h"
#include "osgRayTrace/photons/PointMap.h"
#include "osgRayTrace/photons/RadiusSchedule.h"

namespace osgRayTrace::engine
{

/// Holds the photons of a pass within media; immutable.
struct VolumePhotons
{
    BeamMap beams;
    PointMap points; ///< in dense media, and in volumes and next to them

    bool isEmpty() const { return beams.size() == 0 && points.size() == 0; }
    std::size_t bytes() const { return beams.bytes() + points.bytes(); }
};

/// The largest radius of kernels within media, over that of the scene. Whoever sets a radius may
/// get larger ones, but not in scenes with volumes: photons leave no points farther from a volume.
constexpr float kWidestKernel = 0.02f;

/// The exponents of the schedules of kernels of d dimensions, whose measure goes with the number of
/// passes to the power of alpha - 1 [Knaus11; Jarosz11b]. Variance then goes with -alpha and
/// squared bias with -4 (1 - alpha) / d; both fall alike for alpha = 4 / (4 + d).
constexpr double kBeamAlpha = 4.0 / 5.0;
constexpr double kPointAlpha = 4.0 / 7.0;

/// Returns the radius of a beam's kernel in pass number pass (from 0) over that of the first pass:
/// the product of (i + alpha) / (i + 1), as a kernel of one dimension has the radius for its
/// measure.
inline double beamRadiusScale(int pass)
{
    return globalRadiusSquared(pass, kBeamAlpha);
}

/// Returns the same for the radius of spheres, whose measure is its cube.
inline double pointRadiusScale(int pass)
{
    return std::cbrt(globalRadiusSquared(pass, kPointAlpha));
}

} // namespace osgRayTrace::engine
