// TrafficScene.cpp - builds the town and places its cars. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/TrafficScene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRoads = 5;           ///< roads each way
constexpr float kSpacing = 40.0f;   ///< between roads
constexpr double kHalfTown = 100.0; ///< cars come back at the other end
constexpr double kSpeed = 0.4;      ///< metres a frame: 12 m/s
constexpr Vec3 kPaint[] = {{0.6f, 0.05f, 0.05f},  {0.05f, 0.1f, 0.5f}, {0.7f, 0.7f, 0.7f},
                           {0.05f, 0.05f, 0.05f}, {0.7f, 0.6f, 0.1f},  {0.1f, 0.35f, 0.15f}};

uint32_t addMaterial(Scene& scene, Vec3 color, float roughness, float ior)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.baseColor = color;
    material.roughness = roughness;
    material.ior = ior;
    material.changed = 1;
    scene.materials.push_back(material);
    return static_cast<uint32_t>(scene.materials.size() - 1);
}

/// Returns a number in [0,1) that depends on i alone.
double scatter(int i)
{
    const double x = 0.6180339887 * (i + 1);
    return x - std::floor(x);
}

struct Triangles
{
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;

    void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
    {
        const auto first = static_cast<uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c, d});
        triangles.insert(triangles.end(),
                         {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    }
    /// Adds the sides and the top of a box.
    void box(Vec3 low, Vec3 high)
    {
        const Vec3 base[4] = {
            low, {high.x, low.y, low.z}, {high.x, high.y, low.z}, {low.x, high.y, low.z}};
        const Vec3 up(0.0f, 0.0f, high.z - low.z);
        for (int i = 0; i < 4; ++i)
            quad(base[i], base[(i + 1) % 4], base[(i + 1) % 4] + up, base[i] + up);
        quad(base[0] + up, base[1] + up, base[2] + up, base[3] + up);
    }
    std::shared_ptr<Mesh> mesh()
    {
        auto result = std::make_shared<Mesh>();
        positions.reserve(positions.size() + 1); // Embree reads past the last one
        result->positions = std::move(positions);
        result->triangles = std::move(triangles);
        result->changed = 1;
        return result;
    }
};

uint32_t addInstance(Scene& scene, uint32_t mesh, uint32_t material)
{
    Instance instance;
    instance.mesh = mesh;
    instance.material = material;
    instance.changed = 1;
    scene.instances.push_back(instance);
    return static_cast<uint32_t>(scene.instances.size() - 1);
}

void addPart(Scene& scene, Triangles& triangles, uint32_t material)
{
    scene.meshes.push_back(triangles.mesh());
    addInstance(scene, static_cast<uint32_t>(scene.meshes.size() - 1), material);
}

float roadAt(int i)
{
    return kSpacing * (static_cast<float>(i) - 0.5f * (kRoads - 1));
}

void addDaylight(Scene& scene)
{
    auto sky = std::make_shared<EnvironmentImage>();
    sky->width = 2;
    sky->height = 2;
    sky->radiance = {Vec3(0.15f), Vec3(0.15f), Vec3(0.45f, 0.6f, 0.9f), Vec3(0.5f, 0.6f, 0.8f)};
    Light around;
    around.kind = LightKind::Environment;
    around.radiance = Vec3(0.7f);
    around.environment.image = sky;
    around.changed = 1;
    Light sun;
    sun.kind = LightKind::Directional;
    sun.diffuse = Vec3(0.9f, 0.85f, 0.75f);
    sun.direction = glm::normalize(Vec3(0.6f, 0.35f, -0.8f));
    sun.sine = 0.0047f;
    sun.changed = 1;
    scene.lights = {sun, around};
}

} // namespace

TrafficScene::TrafficScene(int movers)
{
    _base.displayReferred = false;
    _base.changed = 1;
    addDaylight(_base);
    addTown();
    addCars(movers);
}

void TrafficScene::addTown()
{
    Triangles ground, roads;
    ground.quad({-400, -400, 0}, {400, -400, 0}, {400, 400, 0}, {-400, 400, 0});
    addPart(_base, ground, addMaterial(_base, Vec3(0.25f, 0.32f, 0.18f), 1.0f, 1.0f));
    for (int i = 0; i < kRoads; ++i)
    {
        const float at = roadAt(i);
        roads.quad({-400, at - 4, 0.02f}, {400, at - 4, 0.02f}, {400, at + 4, 0.02f},
                   {-400, at + 4, 0.02f});
        roads.quad({at - 4, -400, 0.03f}, {at + 4, -400, 0.03f}, {at + 4, 400, 0.03f},
                   {at - 4, 400, 0.03f});
    }
    addPart(_base, roads, addMaterial(_base, Vec3(0.12f), 1.0f, 1.0f));
    for (int i = 0; i < (kRoads - 1) * (kRoads - 1); ++i)
    {
        const float x = roadAt(i % (kRoads - 1)) + 0.5f * kSpacing,
                    y = roadAt(i / (kRoads - 1)) + 0.5f * kSpacing;
        Triangles house;
        const auto height = static_cast<float>(5.0 + 12.0 * scatter(i));
        house.box({x - 9, y - 9, 0}, {x + 9, y + 9, height});
        const auto shade = static_cast<float>(0.45 + 0.35 * scatter(3 * i + 1));
        addPart(_base, house, addMaterial(_base, shade * Vec3(1.0f, 0.9f, 0.8f), 1.0f, 1.0f));
    }
}

void TrafficScene::addCars(int movers)
{
    Triangles car;
    car.box({-2.1f, -0.9f, 0.3f}, {2.1f, 0.9f, 0.9f});
    car.box({-1.3f, -0.8f, 0.9f}, {0.9f, 0.8f, 1.5f});
    _base.meshes.push_back(car.mesh());
    const auto mesh = static_cast<uint32_t>(_base.meshes.size() - 1);
    uint32_t paints[std::size(kPaint)];
    for (std::size_t i = 0; i < std::size(kPaint); ++i)
        paints[i] = addMaterial(_base, kPaint[i], 0.4f, 1.5f);
    for (int i = 0; i < kCars; ++i)
    {
        const double lane = i & 1 ? 2.0 : -2.0;
        Car next;
        next.alongX = (i >> 1) & 1;
        next.road = roadAt((i >> 2) % kRoads) + lane;
        next.start = kHalfTown * (2.0 * scatter(i) - 1.0);
        next.speed = i < movers ? (i & 1 ? kSpeed : -kSpeed) : 0.0;
        next.instance =
            addInstance(_base, mesh, paints[static_cast<std::size_t>(i) % std::size(kPaint)]);
        _base.instances.back().placed = true;
        _base.instances.back().engineFromLocal = placeOf(next, 0);
        _cars.push_back(next);
    }
}

Affine TrafficScene::placeOf(const Car& car, int frame)
{
    const double turn = 2.0 * kHalfTown, way = car.start + car.speed * frame + kHalfTown;
    const auto at = static_cast<float>(way - turn * std::floor(way / turn) - kHalfTown),
               across = static_cast<float>(car.road);
    Affine place;
    place.translation = car.alongX ? Vec3(at, across, 0.0f) : Vec3(across, at, 0.0f);
    if (!car.alongX) place.linear = Mat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
    return place;
}

std::shared_ptr<const Scene> TrafficScene::at(int frame) const
{
    auto scene = std::make_shared<Scene>(_base);
    for (const Car& car : _cars)
    {
        if (car.speed == 0.0) continue;
        Instance& instance = scene->instances[car.instance];
        instance.engineFromLocal = placeOf(car, frame);
        instance.changed = static_cast<Stamp>(frame) + 2;
    }
    scene->changed = static_cast<Stamp>(frame) + 2;
    return scene;
}

bool TrafficScene::moves(uint32_t instance) const
{
    return std::any_of(_cars.begin(), _cars.end(),
                       [instance](const Car& car)
                       { return car.instance == instance && car.speed != 0.0; });
}

View TrafficScene::view(int width, int height)
{
    View view;
    view.width = width;
    view.height = height;
    view.viewFromWorld = glm::lookAt(Vec3d(-62, -78, 34), Vec3d(0, 0, 0), Vec3d(0, 0, 1));
    view.clipFromView = glm::perspective(glm::radians(50.0), double(width) / height, 0.5, 2000.0);
    return view;
}

} // namespace osgRayTrace::bench
