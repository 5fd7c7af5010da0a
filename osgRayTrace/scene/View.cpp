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

/// The near plane in homogeneous view coordinates, and the point that all rays come from.
struct NearPlane
{
    double z;           ///< its clip coordinate
    Vec4d at00, dx, dy; ///< at pixel (0, 0), and what a pixel adds to it
    Vec4d pole;         ///< the eye, or the direction of parallel rays
};

CameraRays parallelRays(const NearPlane& plane, const Mat4d& engineFromView)
{
    // Rays run from the near plane to the far plane, at half of it to clip z = 0.
    const glm::dmat3 rotation(engineFromView);
    const double w = plane.at00.w;
    CameraRays rays;
    rays.orthographic = true;
    rays.origin = Vec3(engineFromView * Vec4d(Vec3d(plane.at00) / w, 1.0));
    rays.originDx = Vec3(rotation * (Vec3d(plane.dx) / w));
    rays.originDy = Vec3(rotation * (Vec3d(plane.dy) / w));
    rays.direction = Vec3(rotation * (-plane.z * Vec3d(plane.pole) / w));
    rays.nearS = 0.0f;
    rays.depthSlope = static_cast<float>(-0.5 * plane.z);
    return rays;
}

CameraRays perspectiveRays(const NearPlane& plane, const Mat4d& engineFromView)
{
    // dir = N.xyz * E.w - E.xyz * N.w, linear in the pixel position because E is one point.
    // Dividing by E.w and by N.w at the first pixel makes s = 1 the near plane.
    const glm::dmat3 rotation(engineFromView);
    const Vec4d& near00 = plane.at00;
    const Vec3d eye = Vec3d(plane.pole) / plane.pole.w;
    const auto direction = [&](const Vec4d& n) { return (Vec3d(n) - eye * n.w) / near00.w; };
    CameraRays rays;
    rays.orthographic = false;
    rays.origin = Vec3(engineFromView * Vec4d(eye, 1.0));
    rays.direction = Vec3(rotation * direction(near00));
    rays.directionDx = Vec3(rotation * direction(plane.dx));
    rays.directionDy = Vec3(rotation * direction(plane.dy));
    rays.nearS = 1.0f;
    // Clip coordinates of N are (x, y, nearZ, 1) / N.w, those of E (0, 0, 1, 0) / E.w: w grows by
    // 1 / near00.w with s, z begins at 1 / E.w.
    rays.depthSlope = static_cast<float>(0.5 * near00.w / plane.pole.w);
    rays.depthDx = static_cast<float>(plane.dx.w / near00.w);
    rays.depthDy = static_cast<float>(plane.dy.w / near00.w);
    return rays;
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

    const NearPlane plane{nearZ, near00, nearDx, nearDy, pole};
    CameraRays rays =
        orthographic ? parallelRays(plane, engineFromView) : perspectiveRays(plane, engineFromView);
    rays.nearDepth = nearZ > 0.0 ? 1.0f : 0.0f;

    const Mat4d clipFromEngine = glm::transpose(clipFromView * viewFromEngine);
    rays.depthRow = Vec4(clipFromEngine[2]);
    rays.wRow = Vec4(clipFromEngine[3]);
    if (!isFinite(rays)) return std::nullopt;
    return rays;
}

Vec3 lineOfSight(const View& view)
{
    return Vec3(-glm::normalize(Vec3d(glm::transpose(glm::dmat3(view.viewFromWorld))[2])));
}

void openLens(const View& view, double aperture, double distance, CameraRays& rays)
{
    if (rays.orthographic || !(aperture > 0.0) || !(distance > 0.0)) return;
    const glm::dmat3 axes = glm::transpose(glm::dmat3(view.viewFromWorld));
    const double radius = 0.5 * aperture;
    const Vec3 lensX(radius * glm::normalize(Vec3d(axes[0])));
    const Vec3 lensY(radius * glm::normalize(Vec3d(axes[1])));
    const Vec3 focus = lineOfSight(view) / static_cast<float>(distance);
    if (!engine::isFinite(lensX) || !engine::isFinite(lensY) || !engine::isFinite(focus)) return;
    rays.lensX = lensX;
    rays.lensY = lensY;
    rays.focus = focus;
}

} // namespace osgRayTrace::engine
