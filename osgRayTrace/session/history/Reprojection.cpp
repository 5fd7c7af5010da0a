// Reprojection.cpp - an accumulated image of one view, carried into another. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/Reprojection.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/history/ProjectedRow.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Holds the quantities by which a pixel of the new view is compared.
struct Surface
{
    Vec3 point; ///< place from the old pole, divided by s
    Vec3 normal;
    float along; ///< distance s along the new ray
    uint32_t object;
};

struct Gathered
{
    Vec4 radiance{0.0f};
    float count = 0.0f;
};

/// Reads the pixels of the old image.
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

    /// Returns whether pixel (x,y) shows the surface.
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

/// Returns the mean of those of the old pixels (x,y) to (x+1,y+1) that agree, in proportion to
/// their samples.
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

/// Returns the weights of the pixels at -1, 0, 1 and 2 for a place at t in [0,1) [Keys81, eq. 4 and
/// 15, a = -1/2].
OSGRAYTRACE_INLINE Vec4 cubicWeights(float t)
{
    const float t2 = t * t, t3 = t2 * t;
    return Vec4(-0.5f * t + t2 - 0.5f * t3, 1.0f - 2.5f * t2 + 1.5f * t3,
                0.5f * t + 2.0f * t2 - 1.5f * t3, -0.5f * t2 + 0.5f * t3);
}

/// Returns the cubic mean of the old pixels (x-1,y-1) to (x+2,y+2), which are all in the image.
/// Four channels are one vector.
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
    // The floor of a number that is at least -1/2 is computed without a call.
    const int left = static_cast<int>(oldX + 1.0f) - 1, bottom = static_cast<int>(oldY + 1.0f) - 1;
    const float u = oldX - static_cast<float>(left), v = oldY - static_cast<float>(bottom);
    // The place in the old image may have been rounded up to its border.
    const int nearestX = std::min(left + (u >= 0.5f), old.map.view.width - 1);
    const int nearestY = std::min(bottom + (v >= 0.5f), old.map.view.height - 1);
    const Surface surface{Vec3(projected.pointX[x], projected.pointY[x], projected.pointZ[x]),
                          Vec3(to.normalX[i], to.normalY[i], to.normalZ[i]), to.along[i],
                          to.object[i]};
    const SurfaceMap& map = old.map;
    const std::size_t nearest = old.index(nearestX, nearestY);
    const bool window =
        left >= 1 && bottom >= 1 && left + 2 < map.view.width && bottom + 2 < map.view.height;
    Gathered found;
    // If these four are interior, all sixteen are smooth: none of them is mixed.
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

/// Returns the number of pixels that took samples.
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

std::size_t reprojectRow(const Reprojector& reprojector, std::size_t y, ProjectedRow& projected)
{
    const SurfaceMap& to = reprojector.to;
    const auto width = static_cast<std::size_t>(to.view.width);
    const std::size_t first = y * width;
    projectRow(reprojector.projection, reprojector.limits, to, static_cast<int>(y), projected);
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
