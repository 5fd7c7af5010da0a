// FeatureScenes.cpp - the Cornell box with features, out of sight or not. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/FeatureScenes.h"

#include "osgRayTrace/bridge/graph/Proxies.h"

#include <functional>
#include <utility>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

/// Holds the parts of the hidden triangle: a feature changes them before they become part of the
/// scene.
struct Hidden
{
    Mesh mesh;
    Instance instance;
    Material material;
};

using Change = std::function<void(Scene&, Hidden&)>;

std::shared_ptr<const Texture> whiteTexel()
{
    auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 1;
    texture->bytes = {255, 255, 255, 255};
    return texture;
}

/// Returns an environment that lights nothing, and is not seen.
Light blackEnvironment()
{
    auto image = std::make_shared<EnvironmentImage>();
    image->width = image->height = 1;
    image->radiance = {Vec3(0.0f)};
    Light light;
    light.kind = LightKind::Environment;
    light.environment.image = image;
    light.environment.visible = false;
    return light;
}

Hidden plainTriangle()
{
    Hidden hidden;
    std::vector<Vec3> positions;
    positions.reserve(4); // Embree reads past the last one
    // The triangle is below the floor of the box.
    positions.insert(positions.end(),
                     {Vec3(270, -20, 270), Vec3(280, -20, 270), Vec3(270, -20, 280)});
    hidden.mesh.positions = std::move(positions);
    hidden.mesh.triangles = std::vector<UVec3>{{0, 1, 2}};
    hidden.material.model = MaterialModel::Physical;
    hidden.material.baseColor = Vec3(0.5f);
    hidden.material.ior = 1.0f;
    return hidden;
}

BenchScene boxWith(int size, const Change& change)
{
    BenchScene bench = cornellBox(size, size);
    auto scene = std::make_shared<Scene>(*bench.scene);
    Hidden hidden = plainTriangle();
    change(*scene, hidden);
    hidden.instance.mesh = static_cast<uint32_t>(scene->meshes.size());
    hidden.instance.material = static_cast<uint32_t>(scene->materials.size());
    scene->meshes.push_back(std::make_shared<Mesh>(hidden.mesh));
    scene->materials.push_back(hidden.material);
    scene->instances.push_back(hidden.instance);
    bench.scene = scene;
    return bench;
}

void emitFaintly(Scene& scene, Hidden& hidden)
{
    hidden.material.emission = Vec3(1e-6f);
    hidden.instance.light = static_cast<uint32_t>(scene.lights.size());
    Light light;
    light.kind = LightKind::Mesh;
    light.radiance = hidden.material.emission;
    light.twoSided = true;
    light.instance = static_cast<uint32_t>(scene.instances.size());
    scene.lights.push_back(light);
}

/// Changes every mesh and material of the box.
template <class ChangeMesh, class ChangeMaterial>
void changeAll(Scene& scene, const ChangeMesh& changeMesh, const ChangeMaterial& changeMaterial)
{
    for (std::shared_ptr<const Mesh>& mesh : scene.meshes)
    {
        auto changed = std::make_shared<Mesh>(*mesh);
        changeMesh(*changed);
        mesh = changed;
    }
    for (Material& material : scene.materials)
        if (material.emission == Vec3(0.0f)) changeMaterial(material);
}

void textureAll(Scene& scene, Hidden&)
{
    scene.textures.push_back(whiteTexel());
    changeAll(
        scene, [](Mesh& mesh) { mesh.uvs = std::vector<Vec2>(mesh.positions.size(), Vec2(0.5f)); },
        [](Material& material) { material.baseColorTexture = 0; });
}

void placeAll(Scene& scene, Hidden&)
{
    for (Instance& instance : scene.instances)
        instance.placed = true;
}

/// Makes a block in the middle of the box of the hidden triangle.
void showBlock(Hidden& hidden)
{
    std::vector<Vec3> positions;
    positions.reserve(9); // Embree reads past the last one
    for (int corner = 0; corner < 8; ++corner)
        positions.emplace_back(corner & 1 ? 380 : 180, corner & 2 ? 300 : 100,
                               corner & 4 ? 380 : 180);
    hidden.mesh.positions = std::move(positions);
    hidden.mesh.triangles =
        std::vector<UVec3>{{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 4, 5}, {0, 5, 1},
                           {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
}

void showProxy(Scene&, Hidden& hidden)
{
    showBlock(hidden);
    hideFromCamera(hidden.material);
}

/// Features that the hidden triangle of a scene can have.
std::vector<std::pair<const char*, Change>> hiddenFeatures()
{
    return {
        {"smoothNormals",
         [](Scene&, Hidden& h) { h.mesh.normals = std::vector<Vec3>(3, Vec3(0, 1, 0)); }},
        {"textures",
         [](Scene& s, Hidden& h)
         {
             s.textures.push_back(whiteTexel());
             h.material.baseColorTexture = 0;
             h.mesh.uvs = std::vector<Vec2>(3, Vec2(0.5f));
         }},
        {"vertexColors, fixedFunction",
         [](Scene&, Hidden& h)
         {
             h.material.model = MaterialModel::FixedFunction;
             h.material.vertexColorUse = VertexColorUse::AmbientAndDiffuse;
             h.mesh.colors = std::vector<Vec4>(3, Vec4(1.0f));
         }},
        {"fixedFunction",
         [](Scene&, Hidden& h) { h.material.model = MaterialModel::FixedFunction; }},
        {"specular",
         [](Scene&, Hidden& h)
         {
             h.material.metallic = 1.0f;
             h.material.roughness = 0.0f;
         }},
        {"rough metal",
         [](Scene&, Hidden& h)
         {
             h.material.metallic = 1.0f;
             h.material.roughness = 0.5f;
         }},
        {"transmission",
         [](Scene&, Hidden& h)
         {
             h.material.transmission = 1.0f;
             h.material.ior = 1.5f;
             h.material.roughness = 0.0f;
         }},
        {"alpha",
         [](Scene&, Hidden& h)
         {
             h.material.alpha = 0.5f;
             h.material.blended = true;
         }},
        {"alpha test, culled faces",
         [](Scene&, Hidden& h)
         {
             h.material.alphaTest = AlphaTest::Greater;
             h.material.alphaReference = 0.5f;
             h.material.culling = FaceCulling::Back;
         }},
        {"proxy", [](Scene&, Hidden& h) { hideFromCamera(h.material); }},
        {"environment", [](Scene& s, Hidden&) { s.lights.push_back(blackEnvironment()); }},
    };
}

} // namespace

std::vector<ScenePair> unusedFeatures(int size)
{
    const BenchScene plain = boxWith(size, [](Scene&, Hidden&) {});
    // The first pair tells what the method itself gives for two scenes that are one.
    std::vector<ScenePair> pairs{{"nothing", plain, boxWith(size, [](Scene&, Hidden&) {})}};
    for (const auto& [name, change] : hiddenFeatures())
        pairs.push_back({name, plain, boxWith(size, change)});
    return pairs;
}

std::vector<ScenePair> generalWays(int size)
{
    const BenchScene plain = boxWith(size, [](Scene&, Hidden&) {});
    return {{"materials looked up at each hit, not constant", plain, boxWith(size, textureAll)},
            {"all meshes placed, not one flat BVH", plain, boxWith(size, placeAll)},
            {"one mesh placed, beside a flat BVH", plain,
             boxWith(size, [](Scene&, Hidden& h) { h.instance.placed = true; })},
            {"a second area light, out of sight", plain, boxWith(size, emitFaintly)},
            {"a block that is a proxy, not traced for all rays",
             boxWith(size, [](Scene&, Hidden& h) { showBlock(h); }), boxWith(size, showProxy)}};
}

} // namespace osgRayTrace::bench
