// CaveView.h - matrices of an eye before a wall. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cave/CaveSetup.h"

#include <optional>

namespace osgRayTrace::app
{

/// Holds matrices in OSG's row-vector convention.
struct CaveView
{
    osg::Matrixd view, projection;
};

/// Returns the place of the eye in the world, with the head in this place.
osg::Vec3d eyePosition(const CaveSetup& setup, const CaveWall& wall, CaveEye eye,
                       const osg::Matrixd& head);

/// Returns the matrices of an eye; nothing if the eye is on the wall's plane or behind it.
std::optional<CaveView> caveView(const CaveSetup& setup, const CaveWall& wall, CaveEye eye,
                                 const osg::Matrixd& head);

} // namespace osgRayTrace::app
