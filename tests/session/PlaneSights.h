// PlaneSights.h - pictures of planes that no ray is traced for, and their way to another view.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/history/Reprojection.h"

#include <cmath>
#include <functional>
#include <vector>

namespace osgRayTrace::engine::test
{

/// Describes a part of a plane, relative to the point of the world that a test chooses.
struct PlanePart
{
    Vec3d point, normal;
    uint32_t object = 1;
    std::function<bool(Vec3d)> inside = [](Vec3d) { return true; };
    float lobe = kInfinity;
};

struct Seen
{
    Vec3d point{0.0};
    uint32_t object = 0;
};

/// Holds the surfaces that the pixels of a view see, computed in double.
struct Sight
{
    View view;
    std::vector<SurfaceSample> samples;
    std::vector<Seen> seen;
};

inline Sight look(const View& view, const std::vector<PlanePart>& planes, Vec3d origin = Vec3d(0.0))
{
    Sight sight{view, {}, {}};
    const Mat4d worldFromClip = glm::inverse(view.clipFromView * view.viewFromWorld);
    const Vec4d pole4 = worldFromClip * Vec4d(0.0, 0.0, 1.0, 0.0);
    const bool orthographic = std::abs(pole4.w) < 1e-12 * glm::length(Vec3d(pole4));
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
        {
            const Vec4d near4 =
                worldFromClip * Vec4d(2.0 * (x + 0.5) / view.width - 1.0,
                                      2.0 * (y + 0.5) / view.height - 1.0, -1.0, 1.0);
            const Vec3d near = Vec3d(near4) / near4.w;
            const Vec3d start = orthographic ? near : Vec3d(pole4) / pole4.w;
            const Vec3d along = orthographic ? glm::normalize(Vec3d(pole4) / near4.w)
                                             : glm::normalize(near - start);
            SurfaceSample sample{Vec3(0.0f), kInfinity, Vec3(0.0f), 0, kInfinity};
            Seen seen;
            for (const PlanePart& plane : planes)
            {
                const double t = glm::dot(plane.normal, origin + plane.point - start) /
                                 glm::dot(plane.normal, along);
                const Vec3d point = start + t * along - origin;
                if (!(t > 0.0) || !(t < sample.distance) || !plane.inside(point)) continue;
                const double side = glm::dot(plane.normal, along) < 0.0 ? 1.0 : -1.0;
                sample = {Vec3(side * plane.normal), static_cast<float>(t), Vec3(0.5f),
                          plane.object, plane.lobe};
                seen = {point, plane.object};
            }
            sight.samples.push_back(sample);
            sight.seen.push_back(seen);
        }
    return sight;
}

using Texture3 = std::function<Vec3(const Seen&)>;

inline SampledImage imageOf(const Sight& sight, const Texture3& texture, float count)
{
    SampledImage image{sight.view.width, sight.view.height, {}, {}};
    for (const Seen& seen : sight.seen)
    {
        const Vec3 c = texture(seen);
        image.radiance.insert(image.radiance.end(), {c.x, c.y, c.z, 1.0f});
        image.count.push_back(count);
    }
    return image;
}

inline SurfaceMap mapOf(const Sight& sight)
{
    SurfaceMap map;
    REQUIRE(beginSurfaceMap(sight.view, map));
    const CameraRays& rays = map.rays.rays;
    for (std::size_t i = 0; i < sight.samples.size(); ++i)
    {
        const auto width = static_cast<std::size_t>(sight.view.width);
        const float x = static_cast<float>(i % width) + 0.5f;
        const float y = static_cast<float>(i / width) + 0.5f;
        const SurfaceSample& sample = sight.samples[i];
        map.normalX[i] = sample.normal.x;
        map.normalY[i] = sample.normal.y;
        map.normalZ[i] = sample.normal.z;
        map.along[i] = sample.distance /
                       glm::length(rays.direction + x * rays.directionDx + y * rays.directionDy);
        map.lobe[i] = sample.lobe;
        map.object[i] = sample.object;
    }
    findSmooth(Workers(1), map);
    findInteriors(Workers(1), map);
    return map;
}

inline SampledImage carry(const SampledImage& image, const Sight& from, const Sight& to,
                          int threads = 1, const ReprojectionLimits& limits = {})
{
    SampledImage result;
    reproject(image, mapOf(from), mapOf(to), limits, Workers(threads), result);
    return result;
}

inline View offAxisView(Vec3d eye, Vec3d centre, int width, int height)
{
    View view;
    view.viewFromWorld = glm::lookAt(eye, centre, Vec3d(0, 1, 0));
    view.clipFromView = glm::frustum(-0.1, 0.7, -0.5, 0.2, 1.0, 500.0);
    view.width = width;
    view.height = height;
    return view;
}

inline View orthographicView(Vec3d eye, Vec3d centre, int width, int height)
{
    View view;
    view.viewFromWorld = glm::lookAt(eye, centre, Vec3d(0, 1, 0));
    view.clipFromView = glm::ortho(-3.0, 3.0, -2.0, 2.0, 0.1, 100.0);
    view.width = width;
    view.height = height;
    return view;
}

inline View infiniteView(Vec3d eye, Vec3d centre, int width, int height)
{
    View view = offAxisView(eye, centre, width, height);
    view.clipFromView = glm::infinitePerspective(0.8, double(width) / height, 0.01);
    return view;
}

/// Returns waves of about twelve pixels.
inline Vec3 waves(const Seen& seen)
{
    if (seen.object == 0) return Vec3(0.0f);
    const auto wave = [](double v) { return static_cast<float>(1.0 + 0.5 * std::sin(v)); };
    return Vec3(wave(7.0 * seen.point.x), wave(7.0 * seen.point.y),
                wave(5.0 * (seen.point.x + seen.point.y)));
}

const PlanePart kWall{{0, 0, 0}, {0, 0, 1}};

} // namespace osgRayTrace::engine::test
