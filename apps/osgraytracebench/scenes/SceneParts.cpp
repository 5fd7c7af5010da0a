// SceneParts.cpp - adds materials, parallelograms and boxes to scenes. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/SceneParts.h"

#include <glm/gtc/matrix_transform.hpp>

namespace osgRayTrace::bench
{

using namespace engine;

uint32_t materialOf(Scene& scene, Vec3 albedo, Vec3 emission)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.baseColor = albedo;
    material.ior = 1.0f;
    material.emission = emission;
    scene.materials.push_back(material);
    return static_cast<uint32_t>(scene.materials.size() - 1);
}

void addMesh(Scene& scene, std::vector<Vec3> positions, std::vector<UVec3> triangles,
             uint32_t material, uint32_t light)
{
    auto mesh = std::make_shared<Mesh>();
    positions.reserve(positions.size() + 1); // Embree reads past the last one
    mesh->positions = std::move(positions);
    mesh->triangles = std::move(triangles);
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene.meshes.size());
    instance.material = material;
    instance.light = light;
    scene.meshes.push_back(mesh);
    scene.instances.push_back(instance);
}

void addQuad(Scene& scene, Vec3 corner, Vec3 u, Vec3 v, uint32_t material, uint32_t light)
{
    addMesh(scene, {corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}},
            material, light);
}

void addPanel(Scene& scene, Vec3 corner, Vec3 u, Vec3 v, uint32_t material)
{
    Light light;
    const auto number = static_cast<uint32_t>(scene.lights.size());
    light.kind = LightKind::Parallelogram;
    light.instance = static_cast<uint32_t>(scene.instances.size());
    light.radiance = scene.materials[material].emission;
    light.corner = corner;
    light.edgeU = u;
    light.edgeV = v;
    addQuad(scene, corner, u, v, material, number);
    scene.lights.push_back(light);
}

void addBox(Scene& scene, Vec3 low, Vec3 high, uint32_t material)
{
    const Vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    addQuad(scene, low, y, x, material);
    addQuad(scene, low + z, x, y, material);
    addQuad(scene, low, x, z, material);
    addQuad(scene, low + y, z, x, material);
    addQuad(scene, low, z, y, material);
    addQuad(scene, low + x, y, z, material);
}

View viewOf(Vec3d eye, Vec3d centre, int width, int height)
{
    View view;
    view.width = width;
    view.height = height;
    view.viewFromWorld = glm::lookAt(eye, centre, Vec3d(0, 0, 1));
    view.clipFromView =
        glm::perspective(glm::radians(60.0), static_cast<double>(width) / height, 0.1, 1000.0);
    return view;
}

} // namespace osgRayTrace::bench
