// View.cpp - camera rays from any projection matrix, in double. Layer: scene.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/scene/View.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

bool isFinite(const Mat4d& m)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row])) return false;
    return true;
}

bool isFinite(const CameraRays& rays)
{
    return engine::isFinite(rays.origin) && engine::isFinite(rays.originDx) &&
           engine::isFinite(rays.originDy) && engine::isFinite(rays.direction) &&
           engine::isFinite(rays.directionDx) && engine::isFinite(rays.directionDy) &&
           std::isfinite(rays.depthSlope) && std::isfinite(rays.depthDx) &&
           std::isfinite(rays.depthDy);
}

/// Returns the clip z of the near plane of a perspective view: -1 or 1, whichever is nearer to the
/// eye. Reversed depth has the near plane at 1; an infinite far plane has w = 0.
template <class PlanePoint> double nearPlaneZ(const PlanePoint& planePoint, const Vec4d& pole)
{
    const Vec3d eye = Vec3d(pole) / pole.w;
    const auto distance = [&](double z)
    {
        const Vec4d n = planePoint(0.0, 0.0, z);
        return n.w == 0.0 ? HUGE_VAL : glm::length(Vec3d(n) / n.w - eye);
    };
    return distance(1.0) < distance(-1.0) ? 1.0 : -1.0;
}

} // namespace

std::optional<CameraRays> cameraRays(const View& view, Vec3d sceneOrigin, double sceneUnit)
{
    if (view.width <= 0 || view.height <= 0) return std::nullopt;
    if (!isFinite(view.viewFromWorld) || !isFinite(view.clipFromView)) return std::nullopt;

    // The translation to the engine's origin is folded into the view matrix, where large numbers
    // cancel.
    Mat4d viewFromEngine = view.viewFromWorld;
    viewFromEngine[3] = view.viewFromWorld * Vec4d(sceneOrigin, 1.0);
    // View space is measured in engine units, too: p = unit * q turns clip coordinates into
    // unit * (columns 0 to 2, column 3 / unit) * (q, 1), and their common factor means nothing.
    Mat4d clipFromView = view.clipFromView;
    for (int row = 0; row < 3; ++row)
        viewFromEngine[3][row] /= sceneUnit;
    clipFromView[3] /= sceneUnit;
    const Mat4d viewFromClip = glm::inverse(clipFromView);
    const Mat4d engineFromView = glm::inverse(viewFromEngine);
    if (!isFinite(viewFromClip) || !isFinite(engineFromView)) return std::nullopt;

    // Points of the plane clip z are affine in the pixel position, in homogeneous view coordinates.
    const auto planePoint = [&](double x, double y, double z) {
        return viewFromClip *
               Vec4d(2.0 * x / view.width - 1.0, 2.0 * y / view.height - 1.0, z, 1.0);
    };
    const Vec4d pole = viewFromClip * Vec4d(0.0, 0.0, 1.0, 0.0);
    const bool orthographic = std::abs(pole.w) <= 1e-14 * glm::length(Vec3d(pole));

    // Parallel rays do not say which way they run: the eye looks along -z.
    const double orthographicZ = pole.z / planePoint(0.0, 0.0, 0.0).w > 0.0 ? 1.0 : -1.0;
    const double nearZ = orthographic ? orthographicZ : nearPlaneZ(planePoint, pole);
    const Vec4d near00 = planePoint(0.0, 0.0, nearZ);
    const Vec4d nearDx = planePoint(1.0, 0.0, nearZ) - near00;
    const Vec4d nearDy = planePoint(0.0, 1.0, nearZ) - near00;
    if (near00.w == 0.0) return std::nullopt;

    CameraRays rays;
    rays.orthographic = orthographic;
    const glm::dmat3 rotation(engineFromView);
    if (orthographic)
    {
        // Rays run from the near plane to the far plane and meet clip z = 0 at half of the way.
        rays.origin = Vec3(engineFromView * Vec4d(Vec3d(near00) / near00.w, 1.0));
        rays.originDx = Vec3(rotation * (Vec3d(nearDx) / near00.w));
        rays.originDy = Vec3(rotation * (Vec3d(nearDy) / near00.w));
        rays.direction = Vec3(rotation * (-nearZ * Vec3d(pole) / near00.w));
        rays.nearS = 0.0f;
        rays.depthSlope = static_cast<float>(-0.5 * nearZ);
    }
    else
    {
        // dir = N.xyz * E.w - E.xyz * N.w is linear in the pixel position because E is one point.
        // The division by E.w and by N.w at the first pixel makes s = 1 the near plane.
        const Vec3d eye = Vec3d(pole) / pole.w;
        const auto direction = [&](const Vec4d& n) { return (Vec3d(n) - eye * n.w) / near00.w; };
        rays.origin = Vec3(engineFromView * Vec4d(eye, 1.0));
        rays.direction = Vec3(rotation * direction(near00));
        rays.directionDx = Vec3(rotation * direction(nearDx));
        rays.directionDy = Vec3(rotation * direction(nearDy));
        rays.nearS = 1.0f;
        // The clip coordinates of N are (x, y, nearZ, 1) / N.w, and those of E are (0, 0, 1, 0) /
        // E.w: w grows by 1 / near00.w with s, and z begins at 1 / E.w.
        rays.depthSlope = static_cast<float>(0.5 * near00.w / pole.w);
        rays.depthDx = static_cast<float>(nearDx.w / near00.w);
        rays.depthDy = static_cast<float>(nearDy.w / near00.w);
    }
    rays.nearDepth = nearZ > 0.0 ? 1.0f : 0.0f;

    const Mat4d clipFromEngine = glm::transpose(clipFromView * viewFromEngine);
    rays.depthRow = Vec4(clipFromEngine[2]);
    rays.wRow = Vec4(clipFromEngine[3]);
    if (!isFinite(rays)) return std::nullopt;
    return rays;
}

} // namespace osgRayTrace::engine
