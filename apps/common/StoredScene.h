// StoredScene.h - the ray traced scene that a model brings with it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

namespace osgRayTrace::app
{

/// The first RayTracedScene in a model, as in "cow.osgt.raytrace" or where a file holds one. Null
/// if there is none.
osg::ref_ptr<RayTracedScene> storedScene(osg::Node& model);

} // namespace osgRayTrace::app
