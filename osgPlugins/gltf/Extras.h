// Extras.h - what authors add to glTF as user values of OSG. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/JsonPlace.h"

#include <osg/Object>

namespace osgRayTrace::gltf
{

/// Gives an object the "extras" of a place as user values: strings, numbers and flags by their
/// names, and what is none of these as JSON text. Extras that are no object have the name "extras".
void setExtras(const JsonPlace& place, osg::Object& object);

} // namespace osgRayTrace::gltf
