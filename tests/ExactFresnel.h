// ExactFresnel.h - reflectance of a smooth dielectric in double, to compare ours with. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace osgRayTrace::engine::test
{

/// The textbook's form, the mean of both polarisations. eta: the index beyond over that before.
inline double exactReflectance(double cosI, double eta)
{
    const double sin2T = (1.0 - cosI * cosI) / (eta * eta);
    if (sin2T >= 1.0) return 1.0;
    const double cosT = std::sqrt(1.0 - sin2T);
    const double s = (cosI - eta * cosT) / (cosI + eta * cosT);
    const double p = (eta * cosI - cosT) / (eta * cosI + cosT);
    return 0.5 * (s * s + p * p);
}

} // namespace osgRayTrace::engine::test
