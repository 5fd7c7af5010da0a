// PluginPath.h - where this project's OSG plugins lie, seen from the program. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::app
{

/// Lets osgDB look for plugins beside this program, in the build tree or in the folder of its
/// installation, before it looks in OpenSceneGraph's. Call it before any file is read.
void addPluginPath();

} // namespace osgRayTrace::app
