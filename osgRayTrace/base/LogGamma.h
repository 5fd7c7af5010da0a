// LogGamma.h - the logarithm of the gamma function, on any thread. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace osgRayTrace::engine
{

/// Returns the logarithm of the gamma function of x > 0. On POSIX systems std::lgamma also writes a
/// sign, which all threads share.
inline double logGamma(double x)
{
#if defined(_WIN32)
    return std::lgamma(x);
#else
    int sign = 1;
    return lgamma_r(x, &sign);
#endif
}

} // namespace osgRayTrace::engine
