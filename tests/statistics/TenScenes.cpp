// TenScenes.cpp - scenes that together have every kind of surface, light and placement.
// SPDX-License-Identifier: MIT
#include "tests/statistics/TenScenes.h"

#include <cmath>

namespace osgRayTrace::engine::test
{

namespace
{

Material rough(Vec3 color, float roughness, float metallic, float transmission = 0.0f,
               float ior = 1.5f)
{
    Material material = lambert(color);
    material.roughness = roughness;
    material.metallic = metallic;
    material.transmission = transmission;
    material.ior = ior;
    return material;
}

/// Returns a floor and a back wall, around z = 0 and y = 1.5.
SceneBuilder room(const Material& floor)
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), floor);
    builder.add(quadMesh({-2, 1.5f, 0}, {4, 0, 0}, {0, 0, 3}), lambert(Vec3(0.3f, 0.5f, 0.7f)));
    return builder;
}

void addCeilingLight(SceneBuilder& builder, float side = 1.4f, Vec3 radiance = Vec3(3, 2.8f, 2.2f))
{
    builder.addQuadLight({-0.5f * side, -0.5f * side, 2.4f}, {0, side, 0}, {side, 0, 0}, radiance);
}

std::shared_ptr<Mesh> withSmoothNormals(std::shared_ptr<Mesh> sphere, Vec3 centre)
{
    std::vector<Vec3> normals;
    for (const Vec3& p : sphere->positions)
        normals.push_back(glm::normalize(p - centre));
    sphere->normals = std::move(normals);
    return sphere;
}

std::shared_ptr<Mesh> withUvs(std::shared_ptr<Mesh> quad)
{
    quad->uvs = std::vector<Vec2>{{0, 0}, {3, 0}, {3, 3}, {0, 3}};
    return quad;
}

std::shared_ptr<Texture> checks(Vec4 a, Vec4 b)
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 8;
    for (int i = 0; i < 64; ++i)
    {
        const Vec4 color = (i % 8 / 2 + i / 16) % 2 ? a : b;
        for (int c = 0; c < 4; ++c)
            texture->floats.push_back(color[c]);
    }
    return texture;
}

SceneBuilder emissiveMeshes()
{
    SceneBuilder builder = room(lambert(Vec3(0.6f)));
    builder.addEmissive(sphereMesh({-0.8f, 0, 1}, 0.35f, 8), lamp(Vec3(4, 2, 1)));
    builder.addEmissive(boxMesh({0.4f, -0.4f, 0.4f}, {1.1f, 0.3f, 0.6f}), lamp(Vec3(1, 2, 4)));
    // The triangles are unequal: a fan around a corner.
    builder.addEmissive(newMesh({{-0.3f, -0.6f, 0.2f},
                                 {0.3f, -0.6f, 0.2f},
                                 {0.3f, -0.5f, 0.25f},
                                 {0.1f, -0.5f, 0.9f},
                                 {-0.3f, -0.5f, 0.9f}},
                                {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}),
                        lamp(Vec3(1.0f)));
    return builder;
}

SceneBuilder textures()
{
    SceneBuilder builder = room(lambert(Vec3(0.5f)));
    builder.scene->textures = {checks({0.9f, 0.2f, 0.1f, 1}, {0.2f, 0.8f, 0.3f, 1}),
                               checks({1, 0.9f, 0.0f, 1}, {1, 0.6f, 1.0f, 1}),
                               checks({1, 1, 1, 1}, {0.1f, 0.3f, 0.6f, 1})};
    Material floor = rough(Vec3(0.9f), 1.0f, 1.0f);
    floor.baseColorTexture = 0;
    floor.metallicRoughnessTexture = 1;
    builder.add(withUvs(quadMesh({-1.5f, -1.8f, 0.2f}, {3, 0, 0}, {0, 2.5f, 0})), floor);
    Material glowing = lamp(Vec3(2.5f));
    glowing.emissionTexture = 2;
    builder.addEmissive(withUvs(quadMesh({-1, 1.2f, 0.6f}, {2, 0, 0}, {0, 0, 1.4f})), glowing);
    return builder;
}

SceneBuilder roughMetal()
{
    SceneBuilder builder = room(rough(Vec3(0.9f, 0.7f, 0.4f), 0.6f, 1.0f));
    builder.add(withSmoothNormals(sphereMesh({0, 0, 0.7f}, 0.5f, 24), {0, 0, 0.7f}),
                rough(Vec3(0.8f), 0.45f, 1.0f));
    addCeilingLight(builder);
    return builder;
}

SceneBuilder glassAndFrost()
{
    SceneBuilder builder = room(lambert(Vec3(0.7f)));
    builder.add(sphereMesh({-0.6f, -0.2f, 0.5f}, 0.45f, 24), glass(1.5f));
    builder.add(boxMesh({0.2f, -0.6f, 0.1f}, {1.1f, -0.4f, 1.1f}), glass(1.5f, 0.7f));
    addCeilingLight(builder, 2.4f);
    return builder;
}

SceneBuilder instances()
{
    SceneBuilder builder = room(lambert(Vec3(0.6f)));
    const auto box = boxMesh({-0.3f, -0.2f, 0}, {0.3f, 0.2f, 0.5f});
    const uint32_t first = builder.add(box, lambert(Vec3(0.7f, 0.3f, 0.2f)));
    for (int k = 0; k < 3; ++k)
    {
        if (k) builder.scene->instances.push_back(builder.scene->instances[first]);
        Instance& instance = k ? builder.scene->instances.back() : builder.scene->instances[first];
        const float c = std::cos(0.6f * float(k)), s = std::sin(0.6f * float(k));
        instance.placed = true;
        instance.mirrored = k == 1;
        instance.engineFromLocal.linear = Mat3(c, s, 0, -s, c, 0, 0, 0, 1.0f + 0.5f * float(k)) *
                                          Mat3(k == 1 ? -1.0f : 1.0f, 0, 0, 0, 1, 0, 0, 0, 1);
        instance.engineFromLocal.translation =
            Vec3(1.0f * float(k) - 1.0f, 0.3f * float(k) - 0.4f, 0);
    }
    const uint32_t light =
        builder.addEmissive(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lamp(Vec3(2.5f)));
    Instance& instance = builder.scene->instances[light];
    instance.placed = true;
    instance.engineFromLocal.linear = Mat3(1.6f, 0, 0, 0, 1.2f, 0.3f, 0, 0, 1);
    instance.engineFromLocal.translation = Vec3(-0.8f, -0.8f, 2.0f);
    return builder;
}

SceneBuilder pointAndArea()
{
    SceneBuilder builder = room(lambert(Vec3(0.6f, 0.5f, 0.4f)));
    builder.add(boxMesh({-0.3f, -0.3f, 0}, {0.3f, 0.3f, 0.8f}), lambert(Vec3(0.4f, 0.6f, 0.4f)));
    builder.addLight(pointLight({-1.2f, -1, 1.5f}, Vec3(0.8f, 0.4f, 0.4f)));
    builder.addLight(pointLight({1.2f, -1.4f, 0.7f}, Vec3(0.2f, 0.3f, 0.6f)));
    addCeilingLight(builder);
    return builder;
}

/// Returns the scene of data/grids.osgt, with its bars simplified to slats, under a larger light.
SceneBuilder grids()
{
    SceneBuilder builder;
    builder.add(quadMesh({-6, -6, 0}, {12, 0, 0}, {0, 12, 0}), lambert(Vec3(0.7f)));
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (int i = 0; i <= 6; ++i)
    {
        const float at = -1.5f + 0.5f * float(i);
        for (const auto& bar : {boxMesh({-1.5f, at - 0.06f, -0.06f}, {1.5f, at + 0.06f, 0.06f}),
                                boxMesh({at - 0.06f, -1.5f, 0.06f}, {at + 0.06f, 1.5f, 0.18f})})
        {
            const auto base = static_cast<uint32_t>(positions.size());
            positions.insert(positions.end(), bar->positions.begin(), bar->positions.end());
            for (const UVec3& t : bar->triangles)
                triangles.push_back(t + UVec3(base));
        }
    }
    const uint32_t first =
        builder.add(newMesh(positions, triangles), lambert(Vec3(0.6f, 0.35f, 0.2f)));
    builder.scene->instances.push_back(builder.scene->instances[first]);
    for (uint32_t k = 0; k < 2; ++k)
    {
        Instance& instance = builder.scene->instances[first + k];
        instance.placed = true;
        instance.engineFromLocal.linear = Mat3(1.0f);
        instance.engineFromLocal.translation = k ? Vec3(1.7f, 0, 1.6f) : Vec3(-1.7f, 0, 0.5f);
    }
    builder.addQuadLight({-1.5f, -2.5f, 4}, {0, 3, 0}, {3, 0, 0}, Vec3(6, 5.8f, 5.4f));
    return builder;
}

SceneBuilder unequalLights()
{
    SceneBuilder builder = room(rough(Vec3(0.7f, 0.5f, 0.5f), 0.5f, 0.0f));
    builder.add(boxMesh({-0.9f, -0.5f, 0}, {-0.4f, 0.2f, 0.9f}),
                rough(Vec3(0.8f), 0.6f, 0.0f, 0.5f));
    builder.add(boxMesh({0.3f, -0.2f, 0}, {0.8f, 0.3f, 0.6f}), rough(Vec3(0.5f), 0.8f, 0.5f));
    addCeilingLight(builder, 1.2f, Vec3(3));
    builder.addQuadLight({-1.8f, -1, 0.5f}, {0, 1.5f, 0}, {0, 0, 1.2f}, Vec3(0.02f, 0.05f, 0.2f));
    builder.addQuadLight({1.8f, -1, 0.2f}, {0, 0, 1.5f}, {0, 1.5f, 0}, Vec3(0.8f, 0.3f, 0.1f),
                         true);
    return builder;
}

SceneBuilder mirrorsAndPolish()
{
    SceneBuilder builder = room(mirror(Vec3(0.8f, 0.8f, 0.9f)));
    builder.add(withSmoothNormals(sphereMesh({0.5f, 0, 0.6f}, 0.5f, 24), {0.5f, 0, 0.6f}),
                rough(Vec3(0.2f, 0.4f, 0.8f), 0.0f, 0.0f));
    builder.add(boxMesh({-1, -0.4f, 0.1f}, {-0.4f, 0.2f, 0.8f}), lambert(Vec3(0.8f, 0.4f, 0.2f)));
    addCeilingLight(builder);
    return builder;
}

} // namespace

std::vector<ComparedScene> tenScenes(int width, int height)
{
    const View inRoom = perspectiveView({0.4, -4, 2}, {0, 0, 0.7}, {0, 0, 1}, 42.0, width, height);
    const View overGrids = perspectiveView({0, -8, 6}, {0, 0, 0.5}, {0, 0, 1}, 40.0, width, height);
    return {{"Cornell box", cornellBox().build(), cornellView(width, height), false, 550.0},
            {"emissive meshes", emissiveMeshes().build(), inRoom},
            {"textures", textures().build(), inRoom},
            {"rough metal", roughMetal().build(), inRoom},
            {"glass and frost", glassAndFrost().build(), inRoom, true},
            {"instances", instances().build(), inRoom},
            {"point and area lights", pointAndArea().build(), inRoom},
            {"grids", grids().build(), overGrids, false, 6.0},
            {"unequal lights", unequalLights().build(), inRoom},
            {"mirrors and polish", mirrorsAndPolish().build(), inRoom, true}};
}

} // namespace osgRayTrace::engine::test
