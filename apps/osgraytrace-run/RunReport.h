// RunReport.h - what became of a foreign program's scenes, written when it ends. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

namespace osgRayTrace::app
{

/// Has the report of the scene written to the file OSGRAYTRACE_RUN_REPORT when the process exits,
/// whether the scene lives that long or not; does nothing if the variable is not set. Any thread
/// may call this.
void reportAtExit(RayTracedScene& scene);

} // namespace osgRayTrace::app
