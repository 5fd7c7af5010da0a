// CaveView.h - matrices of an eye before a wall. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cave/CaveSetup.h"

#include <optional>

namespace osgRayTrace::app
{

/// In OSG's row-vector convention.
struct CaveView
{
    osg::Matrixd view, projection;
};

/// Where the eye is in the world, with the head in this place.
osg::Vec3d eyePosition(const CaveSetup& setup, const CaveWall& wall, CaveEye eye,
                       const osg::Matrixd& head);

/// Nothing if the eye is not before the wall: on its plane or behind it.
std::optional<CaveView> caveView(const CaveSetup& setup, const CaveWall& wall, CaveEye eye,
                                 const osg::Matrixd& head);

} // namespace osgRayTrace::app
