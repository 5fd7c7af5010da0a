// LampScenes.cpp - builds halls, rooms and lamps. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/LampScenes.h"

#include "apps/osgraytracebench/scenes/SceneParts.h"

#include <cmath>
#include <random>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

/// A number in [low, high), alike with every standard library.
class Numbers
{
public:
    explicit Numbers(uint32_t seed) : _engine(seed) {}
    float operator()(float low, float high)
    {
        return low + (high - low) * (static_cast<float>(_engine() >> 8) * 0x1p-24f);
    }

private:
    std::mt19937 _engine;
};

/// Adds a lamp of half a metre that shines down.
void addLamp(Scene& scene, Vec3 place, float power, uint32_t material, LampKind kind)
{
    Light light;
    const auto number = static_cast<uint32_t>(scene.lights.size());
    light.instance = static_cast<uint32_t>(scene.instances.size());
    light.radiance = scene.materials[material].emission;
    const Vec3 corner = place - Vec3(0.25f, 0.25f, 0.0f), u(0.0f, 0.5f, 0.0f), v(0.5f, 0.0f, 0.0f);
    switch (kind)
    {
    case LampKind::Parallelogram:
        light.kind = LightKind::Parallelogram;
        light.corner = corner;
        light.edgeU = u;
        light.edgeV = v;
        addQuad(scene, corner, u, v, material, number);
        break;
    case LampKind::Triangles:
        light.kind = LightKind::Mesh;
        addQuad(scene, corner, u, v, material, number);
        break;
    case LampKind::Point:
        light.kind = LightKind::Point;
        light.position = place;
        light.diffuse = Vec3(power / kPi);
        light.attenuationConstant = 0.0f;
        light.attenuationQuadratic = 1.0f;
        break;
    }
    scene.lights.push_back(light);
}

/// Intensity straight down of all lamps together [W/sr].
constexpr float kTotal = 25000.0f;
constexpr float kLampArea = 0.25f;

} // namespace

BenchScene hall(int lamps, int width, int height, LampKind kind)
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    materialOf(*scene, Vec3(0.5f));
    const uint32_t grey = materialOf(*scene, Vec3(0.6f));
    const float intensity = kTotal / static_cast<float>(lamps);
    const uint32_t shining = materialOf(*scene, Vec3(0.0f), Vec3(intensity / kLampArea));
    const Vec3 x(100, 0, 0), y(0, 100, 0), z(0, 0, 6), o(0.0f);
    addQuad(*scene, o, x, y, grey);
    addQuad(*scene, z, y, x, grey);
    addQuad(*scene, o, z, x, grey);
    addQuad(*scene, y, x, z, grey);
    addQuad(*scene, o, y, z, grey);
    addQuad(*scene, x, z, y, grey);
    Numbers number(7);
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 low(number(2, 96), number(8, 96), 0.0f);
        addBox(*scene, low, low + Vec3(number(0.5f, 3), number(0.5f, 3), number(0.5f, 3)), grey);
    }
    for (int i = 0; i < lamps; ++i)
        addLamp(*scene, Vec3(number(1, 99), number(1, 99), number(5, 5.9f)), intensity, shining,
                kind);
    return {scene, viewOf({50, 10, 4.9}, {50, 20, -1.4}, width, height)};
}

BenchScene rooms(int lamps, int width, int height)
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    materialOf(*scene, Vec3(0.5f));
    const uint32_t grey = materialOf(*scene, Vec3(0.6f));
    const float intensity = kTotal / static_cast<float>(lamps);
    const uint32_t shining = materialOf(*scene, Vec3(0.0f), Vec3(intensity / kLampArea));
    const float top = 3.0f;
    addQuad(*scene, Vec3(0.0f), Vec3(100, 0, 0), Vec3(0, 100, 0), grey);
    addQuad(*scene, Vec3(0, 0, top), Vec3(0, 100, 0), Vec3(100, 0, 0), grey);
    // Walls have a door of 1 m in the middle of each room, and are closed around all of them.
    for (int wall = 0; wall <= 10; ++wall)
    {
        const auto at = 10.0f * static_cast<float>(wall);
        for (int room = 0; room < 10; ++room)
        {
            const auto from = 10.0f * static_cast<float>(room);
            const bool outer = wall == 0 || wall == 10;
            const float gap = outer ? 5.0f : 4.5f;
            for (const float begin : {from, from + 10.0f - gap})
            {
                addBox(*scene, {at - 0.1f, begin, 0}, {at + 0.1f, begin + gap, top}, grey);
                addBox(*scene, {begin, at - 0.1f, 0}, {begin + gap, at + 0.1f, top}, grey);
            }
        }
    }
    Numbers number(11);
    for (int i = 0; i < lamps; ++i)
    {
        const auto room = static_cast<float>((i * 37) % 100);
        const float row = std::floor(room / 10.0f), column = room - 10.0f * row;
        addLamp(
            *scene,
            Vec3(10.0f * column + number(1, 9), 10.0f * row + number(1, 9), number(2.5f, 2.95f)),
            intensity, shining, LampKind::Parallelogram);
    }
    return {scene, viewOf({41, 41, 2.4}, {43, 44, 0.1}, width, height)};
}

std::shared_ptr<Scene> shiningSphere(int triangles, Vec3 offset)
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    materialOf(*scene, Vec3(0.5f));
    const uint32_t shining = materialOf(*scene, Vec3(0.0f), Vec3(1.0f));
    const auto rows = static_cast<uint32_t>(std::sqrt(static_cast<float>(triangles) / 4.0f));
    const uint32_t columns = 2 * rows;
    std::vector<Vec3> positions;
    std::vector<UVec3> faces;
    for (uint32_t i = 0; i <= rows; ++i)
        for (uint32_t j = 0; j < columns; ++j)
        {
            // The poles are left open, as triangles there would have no area.
            const float a = kPi * static_cast<float>(i + 1) / static_cast<float>(rows + 2);
            const float b = 2.0f * kPi * static_cast<float>(j) / static_cast<float>(columns);
            const float r = 1.0f + 0.1f * std::sin(9.0f * a) * std::sin(7.0f * b);
            positions.push_back(offset + r * Vec3(std::sin(a) * std::cos(b),
                                                  std::sin(a) * std::sin(b), std::cos(a)));
        }
    for (uint32_t i = 0; i < rows; ++i)
        for (uint32_t j = 0; j < columns; ++j)
        {
            const uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
            faces.emplace_back(a, a + columns, b + columns);
            faces.emplace_back(a, b + columns, b);
        }
    Light light;
    light.kind = LightKind::Mesh;
    light.radiance = Vec3(1.0f);
    light.instance = 0;
    scene->lights.push_back(light);
    addMesh(*scene, std::move(positions), std::move(faces), shining, 0);
    return scene;
}

} // namespace osgRayTrace::bench
