// StoredScene.h - the ray traced scene that a model brings with it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

namespace osgRayTrace::app
{

/// Returns the first RayTracedScene in a model, as in "cow.osgt.raytrace" or in a file that holds
/// one; null if there is none.
osg::ref_ptr<RayTracedScene> storedScene(osg::Node& model);

} // namespace osgRayTrace::app
