// View.h - one view of the scene, from any projection matrix, and its camera rays. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Matrices are column vector convention (glm): pClip = clipFromView * viewFromWorld * pWorld.
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

/// Camera rays as linear functions of the pixel position (x right, y up, pixel centres at n + 1/2),
/// in engine space. Every view has a pole E that all its rays run through, the image of clip
/// (0,0,1,0); a ray is E + s*(N(x,y) - E) with N on the near plane, so s = 1 there. An orthographic
/// view has its pole at infinity: N(x,y) + s*direction.
struct CameraRays
{
    bool orthographic = false;
    Vec3 origin{0.0f}, originDx{0.0f}, originDy{0.0f}; ///< Dx, Dy are zero for a perspective view
    Vec3 direction{0.0f}, directionDx{0.0f},
        directionDy{0.0f}; ///< not unit; Dx, Dy zero if orthographic
    float nearS = 1.0f;    ///< rays start at s = nearS: 1 for perspective, 0 for orthographic views

    // Window depth at s, without the cancellation of the rows below: orthographic, nearDepth +
    // depthSlope * s; else nearDepth + depthSlope * (1/s - 1 - x*depthDx - y*depthDy).
    float nearDepth = 0.0f; ///< 0; 1 if depth is reversed
    float depthSlope = 0.0f, depthDx = 0.0f, depthDy = 0.0f;

    // Window depth of the point origin(x,y) + s*direction(x,y): rows 3 and 4 of clipFromEngine.
    // Both are clip coordinates in engine units of length: only their quotient means something.
    Vec4 depthRow{0.0f}; ///< clip z = dot(depthRow, (p, 1))
    Vec4 wRow{0.0f};     ///< clip w = dot(wRow, (p, 1))
};

/// All in double, by the homogeneous form: an infinite far plane, reversed depth, off-axis and
/// sheared projections are the same case. Engine space has its origin and its unit of length in the
/// world as Scene says. Nothing for a zero size or matrices that cannot be inverted.
std::optional<CameraRays> cameraRays(const View& view, Vec3d sceneOrigin, double sceneUnit = 1.0);

} // namespace osgRayTrace::engine
