// Nephroid.h - the caustic of a concave mirror wall: the scene and its closed form.
// SPDX-License-Identifier: MIT
//
// Parallel light falls at 45 degrees onto a mirror in the form of an arc of a cylinder of radius 1
// and on to the floor. A point of the floor that it reaches from the wall's azimuth phi after a
// horizontal run s is at (cos phi, sin phi) + s (-cos 2 phi, -sin 2 phi), and its irradiance over
// that of the floor in direct light is
//   G = cos phi / |cos phi - 2 s|
// summed over all phi; infinite on the nephroid s = cos(phi) / 2. On the axis from the centre to
// the wall
//   G(x) = 1 / |1 - 2x| + [x > 1/2 and 1/(2x) > cos 60] 2 / (4x^2 - 1).
#pragma once

#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

/// The floor's direct radiance is 1, its radiance by the wall is G.
SceneBuilder nephroid();

double gainOnAxis(double x);

/// Mean of G over a disc of the floor.
double meanGain(double x, double y, double radius, int steps = 60000);

} // namespace osgRayTrace::engine::test
