// DaylightScenes.cpp - builds rooms, skies and panels. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/DaylightScenes.h"

#include "apps/osgraytracebench/scenes/SceneParts.h"

#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr float kWide = 4.0f, kDeep = 5.0f, kHigh = 2.7f;

std::shared_ptr<const EnvironmentImage> skyImage(Sky sky)
{
    auto image = std::make_shared<EnvironmentImage>();
    image->width = 512;
    image->height = 256;
    image->radiance.resize(512 * 256, Vec3(1.0f));
    for (int y = 0; y < 256; ++y)
    {
        const float z = std::sin(kPi * ((static_cast<float>(y) + 0.5f) / 256.0f - 0.5f));
        const float haze = (1.0f - z) * (1.0f - z);
        const Vec3 zenith(0.3f, 0.5f, 0.9f), horizon(0.6f, 0.5f, 0.3f), ground(0.15f, 0.12f, 0.1f);
        const Vec3 even(z < 0.0f ? 0.5f : 1.0f);
        const Vec3 sunny = z < 0.0f ? ground : zenith + horizon * haze;
        for (int x = 0; x < 512; ++x)
            image->radiance[static_cast<std::size_t>(512 * y + x)] =
                sky == Sky::Even ? even : sunny;
    }
    // The sun is one pixel of 1.2e-4 sr, 40 degrees above the horizon, to the right.
    if (sky == Sky::Sunny) image->radiance[512 * 185 + 370] = Vec3(1.0f, 0.9f, 0.8f) * 1e5f;
    return image;
}

void addSky(Scene& scene, Sky sky)
{
    Light light;
    light.kind = LightKind::Environment;
    light.radiance = Vec3(1.0f);
    light.environment.image = skyImage(sky);
    scene.lights.push_back(light);
}

uint32_t glassOf(Scene& scene, bool thin)
{
    const uint32_t glass = materialOf(scene, Vec3(1.0f));
    Material& material = scene.materials[glass];
    material.transmission = 1.0f;
    material.roughness = 0.0f;
    material.ior = 1.5f;
    auto detail = std::make_shared<MaterialDetail>();
    detail->thinWalled = thin;
    if (thin) material.detail = detail;
    return glass;
}

void addGlazing(Scene& scene, Glazing glazing, float low, float high)
{
    const float size = high - low, x = kWide + 0.1f, begin = 2.0f;
    const auto addPane = [&](float at) {
        addQuad(scene, {at, begin, low}, {0, size, 0}, {0, 0, size}, glassOf(scene, true));
    };
    switch (glazing)
    {
    case Glazing::Open:
        return;
    case Glazing::Panes:
        addPane(x + 0.01f);
        [[fallthrough]];
    case Glazing::Pane:
        addPane(x);
        return;
    case Glazing::Box:
        addBox(scene, {x, begin, low}, {x + 0.01f, begin + size, high}, glassOf(scene, false));
        return;
    }
}

/// Adds floor, ceiling, three walls and boxes on the floor.
std::shared_ptr<Scene> roomWithoutRightWall()
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    materialOf(*scene, Vec3(0.5f));
    const uint32_t grey = materialOf(*scene, Vec3(0.6f)),
                   red = materialOf(*scene, {0.6f, 0.2f, 0.1f});
    addBox(*scene, {-0.2f, -0.2f, -0.2f}, {kWide + 0.2f, kDeep + 0.2f, 0.0f}, grey);
    addBox(*scene, {-0.2f, -0.2f, kHigh}, {kWide + 0.2f, kDeep + 0.2f, kHigh + 0.2f}, grey);
    addBox(*scene, {-0.2f, -0.2f, 0.0f}, {0.0f, kDeep + 0.2f, kHigh}, red);
    addBox(*scene, {0.0f, -0.2f, 0.0f}, {kWide, 0.0f, kHigh}, grey);
    addBox(*scene, {0.0f, kDeep, 0.0f}, {kWide, kDeep + 0.2f, kHigh}, grey);
    addBox(*scene, {1.0f, 3.0f, 0.0f}, {1.8f, 4.0f, 0.8f}, grey);
    addBox(*scene, {2.6f, 3.6f, 0.0f}, {3.2f, 4.4f, 1.5f}, grey);
    return scene;
}

View insideView(int width, int height)
{
    return viewOf({1.6, 0.3, 1.5}, {2.0, 4.0, 0.9}, width, height);
}

} // namespace

BenchScene windowRoom(Sky sky, Glazing glazing, int width, int height)
{
    const std::shared_ptr<Scene> scene = roomWithoutRightWall();
    const float low = 1.0f, high = 2.0f, outside = kWide + 0.2f;
    const uint32_t grey = 1;
    addBox(*scene, {kWide, -0.2f, 0.0f}, {outside, 2.0f, kHigh}, grey);
    addBox(*scene, {kWide, 3.0f, 0.0f}, {outside, kDeep + 0.2f, kHigh}, grey);
    addBox(*scene, {kWide, 2.0f, 0.0f}, {outside, 3.0f, low}, grey);
    addBox(*scene, {kWide, 2.0f, high}, {outside, 3.0f, kHigh}, grey);
    addGlazing(*scene, glazing, low, high);
    addSky(*scene, sky);
    return {scene, insideView(width, height)};
}

BenchScene openGround(Sky sky, int width, int height)
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    materialOf(*scene, Vec3(0.5f));
    const uint32_t grey = materialOf(*scene, Vec3(0.6f));
    addQuad(*scene, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, grey);
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 7; ++j)
        {
            const Vec3 low(1.4f * static_cast<float>(i) - 5.0f, 1.4f * static_cast<float>(j), 0.0f);
            const auto tall = 0.3f + 0.25f * static_cast<float>((3 * i + 5 * j) % 7);
            addBox(*scene, low, low + Vec3(0.7f, 0.7f, tall), grey);
        }
    addSky(*scene, sky);
    return {scene, viewOf({0, -4, 4.5}, {0, 3.4, 0.2}, width, height)};
}

BenchScene panelRoom(bool skewed, int width, int height)
{
    const std::shared_ptr<Scene> scene = roomWithoutRightWall();
    addBox(*scene, {kWide, -0.2f, 0.0f}, {kWide + 0.2f, kDeep + 0.2f, kHigh}, 1);
    const uint32_t shining = materialOf(*scene, Vec3(0.0f), Vec3(2.0f));
    const Vec3 u(skewed ? 0.6f : 0.0f, 4.0f, 0.0f), v(skewed ? 2.4f : 3.0f, 0.0f, 0.0f);
    addPanel(*scene, {0.5f, 0.5f, 2.6f}, u, v, shining);
    return {scene, insideView(width, height)};
}

} // namespace osgRayTrace::bench
