// ProjectedRow.cpp - rays of one view projected into another, as vector code. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/ProjectedRow.h"

#include "osgRayTrace/base/Lanes.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

Vec3d clipOf(const Mat4d& clipFromWorld, const Vec4d& v)
{
    const Vec4d clip = clipFromWorld * v;
    return {clip.x, clip.y, clip.w};
}

/// Points to a row of surfaces of the new view.
struct SurfaceRow
{
    const float* __restrict along;
    const float* __restrict lobe;
};

/// Points to the arrays of a ProjectedRow, as its loop writes them.
struct ProjectedOut
{
    float* __restrict x;
    float* __restrict y;
    float* __restrict pointX;
    float* __restrict pointY;
    float* __restrict pointZ;
    float* __restrict limit;
};

/// Returns the sine of the angle between two rays that meet at a point, less 1e-5, which may be
/// rounding, and at least 0.
OSGRAYTRACE_INLINE float sineBetween(float ax, float ay, float az, float dx, float dy, float dz)
{
    const float cx = ay * dz - az * dy, cy = az * dx - ax * dz, cz = ax * dy - ay * dx;
    const float squares = (ax * ax + ay * ay + az * az) * (dx * dx + dy * dy + dz * dz);
    const float sine = std::sqrt((cx * cx + cy * cy + cz * cz) / squares) - 1e-5f;
    return select(sine > 0.0f, sine, 0.0f);
}

OSGRAYTRACE_KERNEL
void projectInto(const Projection& projection, const ReprojectionLimits& limits, std::size_t width,
                 int row, SurfaceRow in, ProjectedOut out)
{
    const Projection p = projection;
    const float most = limits.count, share = limits.lobeShare, turn = limits.turn;
    const double y = row + 0.5;
    const float yf = static_cast<float>(row) + 0.5f;
    const Vec3d clipStart = p.clip[0][0] + y * p.clip[0][2], clipStartDx = p.clip[0][1];
    const Vec3d clipAlong = p.clip[1][0] + y * p.clip[1][2], clipAlongDx = p.clip[1][1];
    const Vec3 start = p.start + yf * p.startDy, startDx = p.startDx;
    const Vec3 direction = p.direction + yf * p.directionDy, directionDx = p.directionDx;
    const Vec3 parallel = p.oldDirection;
    const uint32_t isParallel = maskOf(parallel != Vec3(0.0f));
    const double right = 2.0 * p.halfWidth, top = 2.0 * p.halfHeight;
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < width; ++i)
    {
        const float xf = static_cast<float>(static_cast<int>(i)) + 0.5f;
        const double x = xf;
        const float nearness = 1.0f / in.along[i];
        const double n = nearness;
        const double clipX =
            n * (clipStart.x + x * clipStartDx.x) + clipAlong.x + x * clipAlongDx.x;
        const double clipY =
            n * (clipStart.y + x * clipStartDx.y) + clipAlong.y + x * clipAlongDx.y;
        const double clipW =
            n * (clipStart.z + x * clipStartDx.z) + clipAlong.z + x * clipAlongDx.z;
        const double w = 1.0 / clipW;
        const double oldX = (clipX * w + 1.0) * p.halfWidth,
                     oldY = (clipY * w + 1.0) * p.halfHeight;

        const float dx = direction.x + xf * directionDx.x, dy = direction.y + xf * directionDx.y,
                    dz = direction.z + xf * directionDx.z;
        const float px = nearness * (start.x + xf * startDx.x) + dx;
        const float py = nearness * (start.y + xf * startDx.y) + dy;
        const float pz = nearness * (start.z + xf * startDx.z) + dz;

        const float ax = select(isParallel, parallel.x, px),
                    ay = select(isParallel, parallel.y, py),
                    az = select(isParallel, parallel.z, pz);
        const float angle = sineBetween(ax, ay, az, dx, dy, dz) + turn;
        // 0/0 satisfies neither of the two conditions below.
        const float byLobe = share * in.lobe[i] / angle;
        const float limit = select(byLobe < most, byLobe, most);

        const uint32_t inside = maskOf(clipW * p.wSign > 0.0) & maskOf(oldX >= 0.0) &
                                maskOf(oldX < right) & maskOf(oldY >= 0.0) & maskOf(oldY < top) &
                                maskOf(nearness >= 0.0f);
        out.x[i] = static_cast<float>(oldX - 0.5);
        out.y[i] = static_cast<float>(oldY - 0.5);
        out.pointX[i] = px;
        out.pointY[i] = py;
        out.pointZ[i] = pz;
        out.limit[i] = select(inside, limit, 0.0f);
    }
}

ProjectedOut outOf(ProjectedRow& row)
{
    return {row.x.data(),      row.y.data(),      row.pointX.data(),
            row.pointY.data(), row.pointZ.data(), row.limit.data()};
}

} // namespace

Projection projectionOf(const SurfaceMap& from, const SurfaceMap& to)
{
    // The translation to the new pole is folded into the view matrix, in which large numbers
    // cancel.
    Mat4d oldFromPole = from.view.viewFromWorld;
    oldFromPole[3] = from.view.viewFromWorld * Vec4d(to.rays.pole, 1.0);
    const Mat4d clip = from.view.clipFromView * oldFromPole;
    const CameraRays& rays = to.rays.rays;
    Projection p;
    p.clip[0][0] = clipOf(clip, Vec4d(Vec3d(rays.origin), 1.0));
    p.clip[0][1] = clipOf(clip, Vec4d(Vec3d(rays.originDx), 0.0));
    p.clip[0][2] = clipOf(clip, Vec4d(Vec3d(rays.originDy), 0.0));
    p.clip[1][0] = clipOf(clip, Vec4d(Vec3d(rays.direction), 0.0));
    p.clip[1][1] = clipOf(clip, Vec4d(Vec3d(rays.directionDx), 0.0));
    p.clip[1][2] = clipOf(clip, Vec4d(Vec3d(rays.directionDy), 0.0));
    p.start = Vec3(to.rays.pole - from.rays.pole + Vec3d(rays.origin));
    p.startDx = rays.originDx;
    p.startDy = rays.originDy;
    p.direction = rays.direction;
    p.directionDx = rays.directionDx;
    p.directionDy = rays.directionDy;

    const CameraRays& old = from.rays.rays;
    if (old.orthographic) p.oldDirection = old.direction;
    const Mat4d oldClip = from.view.clipFromView * from.view.viewFromWorld;
    const Vec3d ahead = Vec3d(old.origin) + Vec3d(old.direction) +
                        0.5 * from.view.width * Vec3d(old.directionDx) +
                        0.5 * from.view.height * Vec3d(old.directionDy);
    p.wSign = (oldClip * Vec4d(from.rays.pole + ahead, 1.0)).w < 0.0 ? -1.0 : 1.0;
    p.halfWidth = 0.5 * from.view.width;
    p.halfHeight = 0.5 * from.view.height;
    return p;
}

void projectRow(const Projection& projection, const ReprojectionLimits& limits,
                const SurfaceMap& to, int y, ProjectedRow& projected)
{
    const auto width = static_cast<std::size_t>(to.view.width);
    const std::size_t first = static_cast<std::size_t>(y) * width;
    projectInto(projection, limits, width, y, {&to.along[first], &to.lobe[first]},
                outOf(projected));
}

} // namespace osgRayTrace::engine
