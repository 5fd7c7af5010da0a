// RadiusSchedule.h - how the radius of photon look-ups shrinks, so that noise and bias both vanish.
// Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/LogGamma.h"
#include "osgRayTrace/base/Math.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Returns the square of the radius of pass number pass (from 0) over that of the first pass: the
/// product of (i + alpha) / (i + 1) for i = 1 to pass [Knaus11, the recurrence of the squared
/// radii], written as gamma functions. Passes are independent of each other.
inline double globalRadiusSquared(int pass, double alpha)
{
    const double n = pass + 1.0;
    return std::exp(logGamma(n + alpha) - logGamma(1.0 + alpha) - logGamma(n + 1.0));
}

/// Returns the same for discs that shrink as if `delay` passes had come before the first one: they
/// stay large for about as many passes, and then go with the same power of the pass.
inline double globalRadiusSquared(int pass, double alpha, int delay)
{
    return globalRadiusSquared(pass + delay, alpha) / globalRadiusSquared(delay, alpha);
}

/// Holds the statistics of a pixel that shrinks its radius by the photons that it has seen: radius
/// reduction and flux correction [Hachisuka08, sect. 4], with statistics that all hit points of the
/// pixel share [Hachisuka09, sect. 4].
struct LocalStatistics
{
    float photons = 0.0f; ///< N
    float radius2 = 0.0f; ///< R^2
    Vec3 flux{0.0f};      ///< tau, weighted by the BSDF [W/sr]
    int passes = 0;
};

/// Adds a pass that found count photons within the radius, whose flux is given.
inline void addPhotons(LocalStatistics& s, uint32_t count, Vec3 flux, float alpha)
{
    ++s.passes;
    if (count == 0) return;
    const float found = static_cast<float>(count);
    const float shrink = (s.photons + alpha * found) / (s.photons + found);
    s.photons += alpha * found;
    s.radius2 *= shrink;
    s.flux = (s.flux + flux) * shrink;
}

/// Returns the radiance after these passes, each of which emits the same number of photons.
inline Vec3 localRadiance(const LocalStatistics& s)
{
    if (s.passes == 0 || !(s.radius2 > 0.0f)) return Vec3(0.0f);
    return s.flux / (kPi * s.radius2 * static_cast<float>(s.passes));
}

} // namespace osgRayTrace::engine
