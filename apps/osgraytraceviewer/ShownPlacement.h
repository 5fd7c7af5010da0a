// ShownPlacement.h - puts a viewer where a camera of the scene is. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/common/StoredView.h"

#include <osgViewer/View>

namespace osgRayTrace::app
{

/// Makes a placement the home of the view's manipulator, and goes there. A view without a
/// manipulator stays.
void showPlacement(const Placement& placement, osg::Node& scene, osgViewer::View& view);

} // namespace osgRayTrace::app
