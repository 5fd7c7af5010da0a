// Nephroid.h - the caustic of a concave mirror wall: the scene and its closed form.
// SPDX-License-Identifier: MIT
//
// Parallel light falls at 45 degrees onto a mirror in the form of an arc of a cylinder of radius 1
// and on to the floor. Light that is reflected at the wall's azimuth phi reaches the floor after a
// horizontal run s at (cos phi, sin phi) + s (-cos 2 phi, -sin 2 phi). Its irradiance there over
// that of the floor in direct light is
// G = cos phi / |cos phi - 2 s|
// summed over all phi, and infinite on the nephroid s = cos(phi) / 2. On the axis from the centre
// to the wall
// G(x) = 1 / |1 - 2x| + [x > 1/2 and 1/(2x) > cos 60] 2 / (4x^2 - 1).
#pragma once

#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

/// Returns a scene in which the floor's direct radiance is 1, and the radiance by the wall is G.
SceneBuilder nephroid();

double gainOnAxis(double x);

/// Returns the mean of G over a disc of the floor.
double meanGain(double x, double y, double radius, int steps = 60000);

} // namespace osgRayTrace::engine::test
