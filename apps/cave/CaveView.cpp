// CaveView.cpp - the off-axis frustum through a screen. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveView.h"

namespace osgRayTrace::app
{

namespace
{

/// Returns the matrix from the screen's own frame, in which the screen lies in the plane of x and z
/// and is seen along +y.
osg::Matrixd worldFromScreen(const CaveWall& wall, const osg::Matrixd& head)
{
    const osg::Matrixd screen = wall.screen.matrix();
    return wall.followsHead ? screen * head : screen;
}

/// Returns the direction from eye to eye for a head that looks at the middle of the wall, upright.
osg::Vec3d acrossTo(const osg::Vec3d& middle, const osg::Matrixd& head)
{
    osg::Vec3d forward = middle - head.getTrans();
    forward.z() = 0.0;
    if (forward.normalize() == 0.0) return osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), head);
    return forward ^ osg::Vec3d(0, 0, 1);
}

} // namespace

osg::Vec3d eyePosition(const CaveSetup& setup, const CaveWall& wall, CaveEye eye,
                       const osg::Matrixd& head)
{
    if (wall.fixedViewer) return wall.viewer;
    if (eye == CaveEye::Centre) return head.getTrans();
    const bool left = (eye == CaveEye::Left) != wall.swapsEyes;
    const osg::Vec3d across = setup.omniStereo && !wall.followsHead
                                  ? acrossTo(wall.screen.position, head)
                                  : osg::Matrixd::transform3x3(osg::Vec3d(1, 0, 0), head);
    return head.getTrans() + across * ((left ? -0.5 : 0.5) * setup.separation);
}

std::optional<CaveView> caveView(const CaveSetup& setup, const CaveWall& wall, CaveEye eye,
                                 const osg::Matrixd& head)
{
    const osg::Matrixd screenFromWorld = osg::Matrixd::inverse(worldFromScreen(wall, head));
    const osg::Vec3d at = eyePosition(setup, wall, eye, head) * screenFromWorld;
    const double distance = -at.y();
    if (!(distance > 1e-6 * (wall.screenWidth + wall.screenHeight))) return std::nullopt;

    const double scale = setup.nearPlane / distance;
    CaveView result;
    result.projection.makeFrustum(
        scale * (-0.5 * wall.screenWidth - at.x()), scale * (0.5 * wall.screenWidth - at.x()),
        scale * (-0.5 * wall.screenHeight - at.z()), scale * (0.5 * wall.screenHeight - at.z()),
        setup.nearPlane, setup.farPlane);
    result.view = screenFromWorld * osg::Matrixd::translate(-at) *
                  osg::Matrixd::lookAt(osg::Vec3d(), osg::Vec3d(0, 1, 0), osg::Vec3d(0, 0, 1));
    return result;
}

} // namespace osgRayTrace::app
