// SkyScenes.h - a plane under an environment, with a formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Returns S9: a plane and a black ball above it under an even sky with a sun, which is one pixel
/// with half of the light. The ball hides a part of the sky from all visible points, and the sun
/// from none of them.
ReportScene sunnySkyScene();

} // namespace osgRayTrace::bench
