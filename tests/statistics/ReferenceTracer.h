// ReferenceTracer.h - a path tracer that shares nothing with the integrators but surfaces and rays.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

/// Returns linear RGB, 3 doubles a pixel, of paths of up to maxBounces edges after the camera ray:
///
/// L = sum over bounces k of beta_k Le(x_k) + sum over delta lights of beta_k f cos pi I V
/// beta_{k+1} = beta_k f cos 2 pi     (4 pi if light also goes through)
///
/// Directions are uniform over the hemisphere, and mirror-like lobes are chosen evenly with them.
/// No light is sampled, and no path is ended by chance. Rays are traced one at a time, and hit
/// points are in double. So the tracer is slow, noisy and too simple to be wrong in the ways in
/// which the integrators could be.
std::vector<double> tracePaths(const TracedScene& traced, const View& view, int maxBounces,
                               int pathsPerPixel, uint32_t seed);

} // namespace osgRayTrace::engine::test
