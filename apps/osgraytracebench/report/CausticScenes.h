// CausticScenes.h - scenes lit by mirrors, with a formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Returns a floor that a point light lights directly and by a flat mirror, seen in that mirror.
/// There is no other light: light that leaves the floor for the upright mirror never comes back
/// down. The picture holds no edge, so that the square of a kernel's bias is that of a smooth
/// density.
ReportScene flatMirrorScene();

/// Returns irradiance / pi of flatMirrorScene's floor by way of the mirror, at (x, y).
double flatMirrorIrradiance(double x, double y);

/// Returns a floor before an upright mirror that is an arc of 120 degrees, in light of one
/// direction: half a nephroid, seen from above.
ReportScene nephroidScene();

} // namespace osgRayTrace::bench
