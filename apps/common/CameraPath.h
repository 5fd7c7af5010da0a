// CameraPath.h - cameras that move: paths that viewers have recorded, and turntables. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "StoredView.h"

#include <osg/AnimationPath>

#include <string>

namespace osgRayTrace::app
{

/// Reads the camera path of a file as osgviewer's key z writes it: lines of a time, a position and
/// a rotation. Throws Failure(kCannotLoad).
osg::ref_ptr<osg::AnimationPath> readCameraPath(const std::string& file);

/// Returns the placement on a path, seconds after its beginning and `after` more, for moments of a
/// frame. The path begins anew after its end, as in osgviewer, but not within a frame.
Placement placementOn(const osg::AnimationPath& path, double seconds, double after,
                      double fovyDegrees);

/// Returns a placement that has gone around an axis, anticlockwise seen from its tip.
Placement turned(const Placement& placement, const osg::Vec3d& pivot, const osg::Vec3d& axis,
                 double angleRadians);

} // namespace osgRayTrace::app
