// SkyScenes.h - a plane under an environment: light from all around that has a formula. Layer:
// apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// S9: a plane and a black ball above it under an even sky with a sun, which is one pixel with half
/// of the light. The ball hides a part of the sky from all that is seen, and the sun from none of
/// it.
ReportScene sunnySkyScene();

} // namespace osgRayTrace::bench
