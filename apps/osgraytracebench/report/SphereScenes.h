// SphereScenes.h - a plane under a point light with a radius, with a formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Returns a scene with a sphere of radius 1/2 at height 1.
ReportScene sphereLightScene();
/// Returns a scene with the sphere at height 1/10: more and less of it is below the horizon of the
/// plane.
ReportScene sunkenSphereScene();

} // namespace osgRayTrace::bench
