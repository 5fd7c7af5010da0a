// Reprojection.cpp - an accumulated image of one view, carried into another. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/Reprojection.h"

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Where the surfaces of the new view's pixels are seen in the old one. Everything is divided by s,
/// the distance along the new ray, and that is 1/s = 0 for what is infinitely far away.
struct Projection
{
    Vec3d clip[2][3]; ///< old clip x, y, w of the rays' starts; of their directions: at (0,0), by
                      ///< x, by y
    Vec3 start, startDx, startDy;             ///< of rays, from the old pole
    Vec3 direction, directionDx, directionDy; ///< of rays
    Vec3 oldDirection{0.0f};                  ///< of all old rays, if those are parallel
    double wSign = 1.0;                       ///< of what the old view sees
    double halfWidth = 0.0, halfHeight = 0.0; ///< of the old image
};

Vec3d clipOf(const Mat4d& clipFromWorld, const Vec4d& v)
{
    const Vec4d clip = clipFromWorld * v;
    return {clip.x, clip.y, clip.w};
}

Projection projectionOf(const SurfaceMap& from, const SurfaceMap& to)
{
    // The translation to the new pole is folded into the view matrix, where large numbers cancel.
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

/// A row of the new view, in the old one.
struct ProjectedRow
{
    explicit ProjectedRow(std::size_t width)
        : x(width), y(width), pointX(width), pointY(width), pointZ(width), limit(width)
    {
    }
    std::vector<float> x, y;                   ///< pixels, whole ones at their centres
    std::vector<float> pointX, pointY, pointZ; ///< from the old pole; divided by s
    std::vector<float> limit;                  ///< of samples; 0: not in the old image
};

/// A row of surfaces of the new view.
struct SurfaceRow
{
    const float* __restrict along;
    const float* __restrict lobe;
};

/// A ProjectedRow as its loop writes it.
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
void projectRow(const Projection& projection, const ReprojectionLimits& limits, std::size_t width,
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
        const float byLobe = share * in.lobe[i] / angle; // 0/0: neither of the two below
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

/// What a pixel of the new view is compared by.
struct Surface
{
    Vec3 point; ///< from the old pole, divided by s
    Vec3 normal;
    float along; ///< s
    uint32_t object;
};

struct Gathered
{
    Vec4 radiance{0.0f};
    float count = 0.0f;
};

/// Reads the old image.
struct OldImage
{
    const SampledImage& image;
    const SurfaceMap& map;

    std::size_t index(int x, int y) const
    {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(map.view.width) +
               static_cast<std::size_t>(x);
    }
    bool contains(int x, int y) const
    {
        return x >= 0 && y >= 0 && x < map.view.width && y < map.view.height;
    }

    /// True if pixel (x,y) shows the surface.
    OSGRAYTRACE_INLINE bool shows(const Surface& surface, int x, int y, std::size_t i) const
    {
        if (map.object[i] != surface.object) return false;
        if (surface.object == 0) return true;
        const Vec3 normal(map.normalX[i], map.normalY[i], map.normalZ[i]);
        if (!(glm::dot(normal, surface.normal) >= kNormalCosine)) return false;
        const CameraRays& c = map.rays.rays;
        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        const float s = map.along[i];
        const Vec3 old = c.origin + px * c.originDx + py * c.originDy +
                         s * (c.direction + px * c.directionDx + py * c.directionDy);
        const float offPlane = std::fabs(glm::dot(normal, surface.along * surface.point - old));
        return offPlane <= kPlaneTolerance * map.rays.footprint * (c.orthographic ? 1.0f : s);
    }

    Vec4 at(std::size_t i) const
    {
        const float* rgba = &image.radiance[4 * i];
        return Vec4(rgba[0], rgba[1], rgba[2], rgba[3]);
    }

    Gathered bilinear(const Surface& surface, bool smooth, int x, int y, float u, float v) const;
    Gathered cubic(int x, int y, float u, float v) const;
};

/// Of the old pixels (x,y) to (x+1,y+1) those that agree, in proportion to their samples.
Gathered OldImage::bilinear(const Surface& surface, bool smooth, int x, int y, float u,
                            float v) const
{
    Gathered sum;
    for (int tap = 0; tap < 4; ++tap)
    {
        const int tx = x + (tap & 1), ty = y + (tap >> 1);
        if (!contains(tx, ty)) continue;
        const std::size_t i = index(tx, ty);
        if (smooth && !map.smooth[i]) continue;
        if (!shows(surface, tx, ty, i)) continue;
        const float weight =
            ((tap & 1) ? u : 1.0f - u) * ((tap >> 1) ? v : 1.0f - v) * image.count[i];
        if (!(weight > 0.0f)) continue;
        sum.radiance += weight * at(i);
        sum.count += weight;
    }
    if (sum.count > 0.0f) sum.radiance /= sum.count;
    return sum;
}

/// Weights of the pixels at -1, 0, 1 and 2 for a place at t in [0,1) [Keys81, eq. 4 and 15, a =
/// -1/2].
OSGRAYTRACE_INLINE Vec4 cubicWeights(float t)
{
    const float t2 = t * t, t3 = t2 * t;
    return Vec4(-0.5f * t + t2 - 0.5f * t3, 1.0f - 2.5f * t2 + 1.5f * t3,
                0.5f * t + 2.0f * t2 - 1.5f * t3, -0.5f * t2 + 0.5f * t3);
}

/// Of the old pixels (x-1,y-1) to (x+2,y+2), which are all in the image. Four channels are one
/// vector.
OSGRAYTRACE_INLINE Gathered OldImage::cubic(int x, int y, float u, float v) const
{
    const Vec4 wx = cubicWeights(u), wy = cubicWeights(v);
    float sum[4] = {};
    for (int j = 0; j < 4; ++j)
    {
        const float* p = &image.radiance[4 * index(x - 1, y - 1 + j)];
        OSGRAYTRACE_SIMD
        for (int c = 0; c < 4; ++c)
            sum[c] += wy[j] * (wx.x * p[c] + wx.y * p[4 + c] + wx.z * p[8 + c] + wx.w * p[12 + c]);
    }
    const float* low = &image.count[index(x, y)];
    const float* high = &image.count[index(x, y + 1)];
    Gathered gathered;
    gathered.radiance = Vec4(sum[0], sum[1], sum[2], sum[3]);
    gathered.count =
        (1.0f - v) * ((1.0f - u) * low[0] + u * low[1]) + v * ((1.0f - u) * high[0] + u * high[1]);
    return gathered;
}

struct Reprojector
{
    Gathered pixel(std::size_t i, std::size_t x, const ProjectedRow& projected) const;

    OldImage old;
    const SurfaceMap& to;
    ReprojectionLimits limits;
    Projection projection;
    SampledImage& result;
};

OSGRAYTRACE_INLINE Gathered Reprojector::pixel(std::size_t i, std::size_t x,
                                               const ProjectedRow& projected) const
{
    const float oldX = projected.x[x], oldY = projected.y[x];
    // The floor of what is -1/2 at least, without a call.
    const int left = static_cast<int>(oldX + 1.0f) - 1, bottom = static_cast<int>(oldY + 1.0f) - 1;
    const float u = oldX - static_cast<float>(left), v = oldY - static_cast<float>(bottom);
    const int nearestX =
        std::min(left + (u >= 0.5f), old.map.view.width - 1); // of a place that was
    const int nearestY = std::min(bottom + (v >= 0.5f), old.map.view.height - 1); // rounded up
    const Surface surface{Vec3(projected.pointX[x], projected.pointY[x], projected.pointZ[x]),
                          Vec3(to.normalX[i], to.normalY[i], to.normalZ[i]), to.along[i],
                          to.object[i]};
    const SurfaceMap& map = old.map;
    const std::size_t nearest = old.index(nearestX, nearestY);
    const bool window =
        left >= 1 && bottom >= 1 && left + 2 < map.view.width && bottom + 2 < map.view.height;
    Gathered found;
    // With these four, all sixteen are smooth: none of them is mixed.
    const bool interior = window && map.interior[old.index(left, bottom)] &&
                          map.interior[old.index(left + 1, bottom)] &&
                          map.interior[old.index(left, bottom + 1)] &&
                          map.interior[old.index(left + 1, bottom + 1)];
    if (interior && old.shows(surface, nearestX, nearestY, nearest))
        found = old.cubic(left, bottom, u, v);
    else
        found = old.bilinear(surface, to.smooth[i], left, bottom, u, v);
    const float most = to.smooth[i] ? limits.count : limits.edgeCount;
    found.count = std::min(found.count, std::min(most, projected.limit[x]));
    return found;
}

/// Returns the number of pixels that took something.
OSGRAYTRACE_KERNEL
std::size_t gatherRow(const Reprojector& reprojector, std::size_t first, std::size_t width,
                      const ProjectedRow& projected)
{
    SampledImage& result = reprojector.result;
    std::size_t found = 0;
    for (std::size_t x = 0; x < width; ++x)
    {
        Gathered gathered;
        if (projected.limit[x] > 0.0f) gathered = reprojector.pixel(first + x, x, projected);
        const Vec4& c = gathered.radiance;
        const float sum = c.x + c.y + c.z + c.w;
        const bool usable = gathered.count > 0.0f && sum - sum == 0.0f;
        float* rgba = &result.radiance[4 * (first + x)];
        for (int k = 0; k < 4; ++k)
            rgba[k] = usable ? c[k] : 0.0f;
        result.count[first + x] = usable ? gathered.count : 0.0f;
        found += usable;
    }
    return found;
}

ProjectedOut outOf(ProjectedRow& row)
{
    return {row.x.data(),      row.y.data(),      row.pointX.data(),
            row.pointY.data(), row.pointZ.data(), row.limit.data()};
}

std::size_t reprojectRow(const Reprojector& reprojector, std::size_t y, ProjectedRow& projected)
{
    const SurfaceMap& to = reprojector.to;
    const auto width = static_cast<std::size_t>(to.view.width);
    const std::size_t first = y * width;
    projectRow(reprojector.projection, reprojector.limits, width, static_cast<int>(y),
               {&to.along[first], &to.lobe[first]}, outOf(projected));
    return gatherRow(reprojector, first, width, projected);
}

} // namespace

double reproject(const SampledImage& old, const SurfaceMap& from, const SurfaceMap& to,
                 const ReprojectionLimits& limits, const Workers& workers, SampledImage& result)
{
    const auto width = static_cast<std::size_t>(to.view.width);
    const std::size_t pixels = width * static_cast<std::size_t>(to.view.height);
    result.width = to.view.width;
    result.height = to.view.height;
    result.radiance.resize(4 * pixels);
    result.count.resize(pixels);
    const Reprojector reprojector{{old, from}, to, limits, projectionOf(from, to), result};
    std::atomic<std::size_t> found{0};
    forEachRows(workers, to.view.height,
                [&](std::size_t first, std::size_t end)
                {
                    ProjectedRow projected(width);
                    std::size_t here = 0;
                    for (std::size_t y = first; y < end; ++y)
                        here += reprojectRow(reprojector, y, projected);
                    found += here;
                });
    return pixels ? static_cast<double>(found) / static_cast<double>(pixels) : 0.0;
}

} // namespace osgRayTrace::engine
