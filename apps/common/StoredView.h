// StoredView.h - how a scene says that it wants to be seen. Layer: apps.
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
    double fovyDegrees = 0.0; ///< vertical
};

/// Of the first osg::CameraView, world space; at unit distance. Nothing if the scene has none.
std::optional<Placement> storedPlacement(osg::Node& scene);

/// Of the first osg::ClearNode. Nothing if the scene has none.
std::optional<osg::Vec4> storedClearColor(osg::Node& scene);

} // namespace osgRayTrace::app
