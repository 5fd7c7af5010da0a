// ChangedSight.cpp - places changed boxes and lights relative to a view. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/ChangedSight.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Takes points of engine space to places relative to the pole.
struct FromPole
{
    const Scene& scene;
    Vec3d pole;

    Vec3 operator()(Vec3 p) const { return Vec3(Vec3d(p) * scene.unit + (scene.origin - pole)); }
};

/// Sets the pixels that the box is seen in, and one more on all sides; all pixels if a part of the
/// box is not in front of the eye.
void findPixels(const View& view, Vec3d pole, SeenBox& box)
{
    const Mat4d clipFromWorld = view.clipFromView * view.viewFromWorld;
    const double wCentre = (clipFromWorld * Vec4d(pole + Vec3d(box.centre), 1.0)).w;
    double left = 1e30, right = -1e30, bottom = 1e30, top = -1e30;
    bool inFront = true;
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec3d p =
            pole + Vec3d(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                         corner & 4 ? box.high.z : box.low.z);
        const Vec4d clip = clipFromWorld * Vec4d(p, 1.0);
        inFront = inFront && clip.w * wCentre > 0.0 && std::abs(clip.w) > 1e-3 * std::abs(wCentre);
        const double x = 0.5 * (clip.x / clip.w + 1.0) * view.width,
                     y = 0.5 * (clip.y / clip.w + 1.0) * view.height;
        left = std::min(left, x);
        right = std::max(right, x);
        bottom = std::min(bottom, y);
        top = std::max(top, y);
    }
    const auto pixel = [](double v, int most)
    { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(most))); };
    const bool known = inFront && left <= right && bottom <= top;
    box.left = known ? pixel(std::floor(left) - 1.0, view.width) : 0;
    box.right = known ? pixel(std::ceil(right) + 1.0, view.width) : view.width;
    box.bottom = known ? pixel(std::floor(bottom) - 1.0, view.height) : 0;
    box.top = known ? pixel(std::ceil(top) + 1.0, view.height) : view.height;
}

SeenBox seenBox(const ChangedBox& box, const FromPole& place, const View& view)
{
    SeenBox seen;
    const Vec3 low = place(box.low), high = place(box.high);
    const Vec3 largest = glm::max(glm::abs(low), glm::abs(high));
    // Rounding of the scene's floats, and of the places here.
    const float slack = 1e-5f * std::max(largest.x, std::max(largest.y, largest.z));
    seen.low = low - slack;
    seen.high = high + slack;
    seen.centre = 0.5f * (seen.low + seen.high);
    const Vec3 d = seen.high - seen.low;
    seen.radius = 0.5f * glm::length(d);
    seen.area = 0.5f * (d.x * d.y + d.y * d.z + d.z * d.x);
    findPixels(view, place.pole, seen);
    return seen;
}

/// Adds a light unless it casts no shadows.
void addLight(const Scene& scene, const Light& light, const FromPole& place,
              std::vector<ShadowLight>& lights)
{
    const auto unit = static_cast<float>(scene.unit);
    ShadowLight result;
    switch (light.kind)
    {
    case LightKind::Directional:
        if (!light.castsShadows) return;
        result = {true, -light.direction, light.sine};
        break;
    case LightKind::Point:
        if (!light.castsShadows) return;
        result = {false, place(light.position), light.radius * unit};
        break;
    case LightKind::Parallelogram:
        result.place = place(light.corner + 0.5f * (light.edgeU + light.edgeV));
        result.size = 0.5f * unit *
                      std::max(glm::length(light.edgeU + light.edgeV),
                               glm::length(light.edgeU - light.edgeV));
        break;
    case LightKind::Mesh:
    {
        if (light.instance >= scene.instances.size()) return;
        const ChangedBox box = instanceBounds(scene, scene.instances[light.instance]);
        if (!(box.low.x <= box.high.x)) return;
        result.place = place(0.5f * (box.low + box.high));
        result.size = 0.5f * unit * glm::length(box.high - box.low);
        break;
    }
    case LightKind::Environment:
        return;
    }
    lights.push_back(result);
}

} // namespace

ChangedSight changedSight(const SurfaceMap& map, const Scene& scene,
                          const std::vector<Light>& lights, const SceneChange& change)
{
    const FromPole place{scene, map.rays.pole};
    ChangedSight sight;
    for (const ChangedBox& box : change.boxes)
        sight.boxes.push_back(seenBox(box, place, map.view));
    for (const Light& light : lights)
    {
        if (sight.lights.size() > kMostShadowLights) break;
        addLight(scene, light, place, sight.lights);
    }
    return sight;
}

bool crosses(const SeenBox& box, float grown, Vec3 start, Vec3 direction, float end)
{
    float first = 0.0f, last = end;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float low = box.low[axis] - grown - start[axis],
                    high = box.high[axis] + grown - start[axis];
        if (direction[axis] == 0.0f)
        {
            if (low > 0.0f || high < 0.0f) return false;
            continue;
        }
        const float a = low / direction[axis], b = high / direction[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

bool mayShade(const ShadowLight& light, const SeenBox& box, Vec3 centre, float radius)
{
    const Vec3 to = box.centre - centre;
    const Vec3 way = light.distant ? light.place : light.place - centre;
    const float squared = glm::dot(way, way);
    const float length = light.distant ? kInfinity : 1.0f;
    const float t = squared > 0.0f ? std::clamp(glm::dot(to, way) / squared, 0.0f, length) : 0.0f;
    const float apart = glm::length(to - t * way);
    const float spread = light.distant ? light.size * (glm::length(to) + radius) : light.size;
    return apart <= box.radius + radius + spread;
}

float shadeOf(const ShadowLight& light, const SeenBox& box, Vec3 point)
{
    const float distance = glm::length(box.centre - point);
    const Vec3 way = light.distant ? light.place : light.place - point;
    const float grown = light.distant ? light.size * (distance + box.radius) : light.size;
    if (!crosses(box, grown, point, way, light.distant ? kInfinity : 1.0f)) return 0.0f;
    const float lightSize = light.distant ? light.size : light.size / glm::length(way);
    const float boxSquared = box.area / (kPi * distance * distance);
    // A small box hides no more of a large light than its own share.
    return boxSquared >= lightSize * lightSize ? 1.0f : boxSquared / (lightSize * lightSize);
}

} // namespace osgRayTrace::engine
