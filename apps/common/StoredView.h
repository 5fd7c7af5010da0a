// StoredView.h - the view and background that a scene asks for. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <optional>

namespace osgRayTrace::app
{

struct Placement
{
    osg::Vec3d eye;
    osg::Vec3d center; ///< a point on the line of sight
    osg::Vec3d up;
    double fovyDegrees = 0.0; ///< vertical [degrees]
};

/// Returns the placement of the first osg::CameraView, in world space, with the centre at unit
/// distance; nothing if the scene has none.
std::optional<Placement> storedPlacement(osg::Node& scene);

/// Returns the colour of the first osg::ClearNode; nothing if the scene has none.
std::optional<osg::Vec4> storedClearColor(osg::Node& scene);

} // namespace osgRayTrace::app
