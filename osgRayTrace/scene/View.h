// View.h - one view of the scene, from any projection matrix, and its camera rays. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Holds matrices in the column vector convention (glm): pClip = clipFromView * viewFromWorld *
/// pWorld.
struct View
{
    Mat4d viewFromWorld{1.0};
    Mat4d clipFromView{1.0};
    int width = 0;  ///< [pixels]
    int height = 0; ///< [pixels]

    bool operator==(const View& other) const
    {
        return viewFromWorld == other.viewFromWorld && clipFromView == other.clipFromView &&
               width == other.width && height == other.height;
    }
    bool operator!=(const View& other) const { return !(*this == other); }
};

/// Holds camera rays as linear functions of the pixel position (x right, y up, pixel centres at n +
/// 1/2), in engine space. Every view has a pole E, the image of clip (0,0,1,0), that all its rays
/// run through. A ray is E + s*(N(x,y) - E) with N on the near plane, so that s = 1 there. An
/// orthographic view has its pole at infinity, and its rays are N(x,y) + s*direction.
struct CameraRays
{
    bool orthographic = false;
    Vec3 origin{0.0f}, originDx{0.0f}, originDy{0.0f}; ///< Dx, Dy are zero for a perspective view
    Vec3 direction{0.0f}, directionDx{0.0f},
        directionDy{0.0f}; ///< not unit; Dx, Dy zero if orthographic
    float nearS = 1.0f;    ///< rays start at s = nearS: 1 for perspective, 0 for orthographic views

    // The next four members give the window depth at s without the cancellation of depthRow and
    // wRow. It is nearDepth + depthSlope * s for an orthographic view, else nearDepth + depthSlope
    // * (1/s - 1 - x*depthDx - y*depthDy).
    float nearDepth = 0.0f; ///< 0, or 1 if depth is reversed
    float depthSlope = 0.0f, depthDx = 0.0f, depthDy = 0.0f;

    // Rows 3 and 4 of clipFromEngine give the window depth of the point origin(x,y) +
    // s*direction(x,y). Both are clip coordinates in engine units of length: only their quotient
    // has a meaning.
    Vec4 depthRow{0.0f}; ///< clip z = dot(depthRow, (p, 1))
    Vec4 wRow{0.0f};     ///< clip w = dot(wRow, (p, 1))

    // A thin lens; zero for a pinhole. The ray through a point L of the lens runs from origin + L
    // in the direction d - L * dot(focus, d), where d is that of the pinhole's ray: all rays of a
    // pixel meet where dot(focus, s * d) = 1 [Cook84].
    Vec3 lensX{0.0f}, lensY{0.0f}; ///< half axes of the lens
    Vec3 focus{0.0f};              ///< line of sight, divided by the distance of the sharp plane

    bool hasLens() const { return lensX != Vec3(0.0f); }
};

/// Returns the camera rays of a view, or nothing for a zero size or for matrices that cannot be
/// inverted. The homogeneous form, computed in double, treats an infinite far plane, reversed
/// depth, off-axis and sheared projections as one case. sceneOrigin and sceneUnit are Scene::origin
/// and Scene::unit.
std::optional<CameraRays> cameraRays(const View& view, Vec3d sceneOrigin, double sceneUnit = 1.0);

/// Returns the line of sight of a view, unit, in engine space.
Vec3 lineOfSight(const View& view);

/// Puts a lens into the rays of a perspective view. aperture is its diameter, distance that of the
/// plane that is seen sharp, along the line of sight [engine units]. Does nothing for parallel rays
/// and for lengths that are not positive.
void openLens(const View& view, double aperture, double distance, CameraRays& rays);

} // namespace osgRayTrace::engine
