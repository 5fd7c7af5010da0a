// ClosedScenes.h - closed rooms whose radiance has a formula: all light paths count. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Returns a room whose walls emit 1 and reflect the albedo: radiance 1 / (1 - albedo) everywhere.
ReportScene furnaceScene(double albedo);

/// Returns a white sphere with a point light away from its centre, seen from within.
ReportScene integratingSphereScene();

} // namespace osgRayTrace::bench
