// DenoiseScenes.cpp - builds boxes from the Cornell box. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/DenoiseScenes.h"

#include "osgRayTrace/sampling/Hash.h"

#include <functional>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr std::size_t kFloor = 0, kBackWall = 2, kLeftWall = 3, kFirstBlock = 5, kBlockFaces = 5;

uint32_t addTexture(Scene& scene, int size, const std::function<Vec3(int, int)>& colorAt)
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = size;
    texture->opaque = true;
    for (int y = 0; y < size; ++y)
    {
        for (int x = 0; x < size; ++x)
        {
            const Vec3 color = colorAt(x, y);
            for (int c = 0; c < 3; ++c)
                texture->bytes.push_back(static_cast<uint8_t>(255.0f * color[c] + 0.5f));
            texture->bytes.push_back(255);
        }
    }
    scene.textures.push_back(texture);
    return static_cast<uint32_t>(scene.textures.size() - 1);
}

/// Covers the quad of an instance with the texture, so many times along each side.
void cover(Scene& scene, std::size_t instance, uint32_t texture, float times)
{
    Instance& target = scene.instances[instance];
    auto mesh = std::make_shared<Mesh>(*scene.meshes[target.mesh]);
    mesh->uvs = std::vector<Vec2>{{0, 0}, {times, 0}, {times, times}, {0, times}};
    scene.meshes[target.mesh] = mesh;
    Material material = scene.materials[target.material];
    material.baseColor = Vec3(1.0f);
    material.baseColorTexture = texture;
    target.material = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
}

} // namespace

BenchScene glossyBox(int width, int height)
{
    BenchScene box = cornellBox(width, height);
    auto scene = std::make_shared<Scene>(*box.scene);
    const auto addMaterial = [&scene](Vec3 color, float metallic, float roughness)
    {
        Material material;
        material.model = MaterialModel::Physical;
        material.baseColor = color;
        material.metallic = metallic;
        material.roughness = roughness;
        scene->materials.push_back(material);
        return static_cast<uint32_t>(scene->materials.size() - 1);
    };
    scene->instances[kFloor].material = addMaterial(Vec3(0.8f, 0.7f, 0.5f), 1.0f, 0.35f);
    scene->instances[kBackWall].material = addMaterial(Vec3(0.5f), 0.0f, 0.3f);
    const uint32_t lacquer = addMaterial({0.1f, 0.2f, 0.6f}, 0.0f, 0.25f);
    const uint32_t steel = addMaterial(Vec3(0.7f), 1.0f, 0.5f);
    for (std::size_t face = 0; face < kBlockFaces; ++face)
    {
        scene->instances[kFirstBlock + face].material = lacquer;
        scene->instances[kFirstBlock + kBlockFaces + face].material = steel;
    }
    return {scene, box.view};
}

BenchScene texturedBox(int width, int height)
{
    BenchScene box = cornellBox(width, height);
    auto scene = std::make_shared<Scene>(*box.scene);
    const uint32_t tiles = addTexture(*scene, 64,
                                      [](int x, int y) {
                                          return ((x / 8 + y / 8) & 1) ? Vec3(0.9f, 0.85f, 0.7f)
                                                                       : Vec3(0.05f, 0.1f, 0.2f);
                                      });
    const uint32_t stripes = addTexture(
        *scene, 64, [](int x, int) { return (x & 16) ? Vec3(0.8f, 0.1f, 0.1f) : Vec3(0.9f); });
    const uint32_t grains =
        addTexture(*scene, 256,
                   [](int x, int y)
                   {
                       const uint32_t bits = hash(static_cast<uint32_t>(256 * y + x));
                       return Vec3(0.1f) + 0.8f / 255.0f *
                                               Vec3(float(bits & 255), float((bits >> 8) & 255),
                                                    float((bits >> 16) & 255));
                   });
    cover(*scene, kFloor, tiles, 2.0f);
    cover(*scene, kBackWall, grains, 1.0f);
    cover(*scene, kLeftWall, stripes, 2.0f);
    for (std::size_t face = 0; face < 2 * kBlockFaces; ++face)
        cover(*scene, kFirstBlock + face, face < kBlockFaces ? stripes : tiles, 1.0f);
    return {scene, box.view};
}

} // namespace osgRayTrace::bench
