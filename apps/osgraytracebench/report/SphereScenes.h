// SphereScenes.h - a plane under a point light with a radius: soft light that has a formula. Layer:
// apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// A sphere of radius 1/2 at height 1.
ReportScene sphereLightScene();
/// The same at height 1/10: more and less of it is below the horizon of the plane.
ReportScene sunkenSphereScene();

} // namespace osgRayTrace::bench
