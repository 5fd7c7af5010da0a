// EngineScenes.cpp - small engine scenes, views and renders that the engine's tests share.
// SPDX-License-Identifier: MIT
#include "tests/EngineScenes.h"

#include "data/generator/CornellBoxTable.h"

#include <cmath>

namespace osgRayTrace::engine::test
{

Material lambert(Vec3 albedo)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.baseColor = albedo;
    material.ior = 1.0f;
    return material;
}

Material mirror(Vec3 tint)
{
    Material material = lambert(tint);
    material.metallic = 1.0f;
    material.roughness = 0.0f;
    return material;
}

Material glass(float ior, float roughness)
{
    Material material = lambert(Vec3(1.0f));
    material.ior = ior;
    material.transmission = 1.0f;
    material.roughness = roughness;
    return material;
}

Material lamp(Vec3 radiance)
{
    Material material = lambert(Vec3(0.0f));
    material.emission = radiance;
    return material;
}

std::shared_ptr<Mesh> newMesh(std::vector<Vec3> positions, std::vector<UVec3> triangles)
{
    auto mesh = std::make_shared<Mesh>();
    positions.reserve(positions.size() + 1); // Embree reads past the last position
    mesh->positions = std::move(positions);
    mesh->triangles = std::move(triangles);
    return mesh;
}

std::shared_ptr<Mesh> quadMesh(Vec3 corner, Vec3 u, Vec3 v)
{
    return newMesh({corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}});
}

std::shared_ptr<Mesh> sphereMesh(Vec3 centre, float radius, int rows)
{
    const int columns = 2 * rows;
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (int row = 0; row <= rows; ++row)
    {
        const double theta = row * glm::pi<double>() / rows;
        for (int column = 0; column < columns; ++column)
        {
            const double phi = column * glm::two_pi<double>() / columns;
            const Vec3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                          std::cos(theta));
            positions.push_back(Vec3(Vec3d(centre) + double(radius) * n));
        }
    }
    const auto index = [columns](int row, int column)
    { return static_cast<uint32_t>(row * columns + column % columns); };
    for (int row = 0; row < rows; ++row)
    {
        for (int column = 0; column < columns; ++column)
        {
            const uint32_t a = index(row, column), b = index(row + 1, column);
            const uint32_t c = index(row + 1, column + 1), d = index(row, column + 1);
            if (row + 1 < rows) triangles.push_back({a, b, c});
            if (row > 0) triangles.push_back({a, c, d});
        }
    }
    return newMesh(std::move(positions), std::move(triangles));
}

std::shared_ptr<Mesh> boxMesh(Vec3 low, Vec3 high)
{
    std::vector<Vec3> p;
    for (int i = 0; i < 8; ++i)
        p.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    return newMesh(p, {{0, 2, 3},
                       {0, 3, 1},
                       {4, 5, 7},
                       {4, 7, 6},
                       {0, 1, 5},
                       {0, 5, 4},
                       {2, 6, 7},
                       {2, 7, 3},
                       {0, 4, 6},
                       {0, 6, 2},
                       {1, 3, 7},
                       {1, 7, 5}});
}

SceneBuilder::SceneBuilder() : scene(std::make_shared<Scene>())
{
    scene->displayReferred = false;
    material(lambert(Vec3(0.5f)));
}

uint32_t SceneBuilder::material(const Material& material)
{
    scene->materials.push_back(material);
    return static_cast<uint32_t>(scene->materials.size() - 1);
}

uint32_t SceneBuilder::add(std::shared_ptr<const Mesh> mesh, const Material& of)
{
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene->meshes.size());
    instance.material = material(of);
    scene->meshes.push_back(std::move(mesh));
    scene->instances.push_back(instance);
    return static_cast<uint32_t>(scene->instances.size() - 1);
}

uint32_t SceneBuilder::addEmissive(std::shared_ptr<const Mesh> mesh, const Material& of)
{
    const uint32_t instance = add(std::move(mesh), of);
    Light light;
    light.kind = LightKind::Mesh;
    light.radiance = of.emission;
    light.twoSided = true;
    light.instance = instance;
    scene->instances[instance].light = addLight(light);
    return instance;
}

uint32_t SceneBuilder::addQuadLight(Vec3 corner, Vec3 u, Vec3 v, Vec3 radiance, bool twoSided)
{
    Light light;
    light.kind = LightKind::Parallelogram;
    light.corner = corner;
    light.edgeU = u;
    light.edgeV = v;
    light.radiance = radiance;
    light.twoSided = twoSided;
    light.instance = add(quadMesh(corner, u, v), lamp(radiance));
    const uint32_t index = addLight(light);
    scene->instances[light.instance].light = index;
    return index;
}

uint32_t SceneBuilder::addLight(const Light& light)
{
    scene->lights.push_back(light);
    return static_cast<uint32_t>(scene->lights.size() - 1);
}

std::shared_ptr<const TracedScene> SceneBuilder::build(int threads) const
{
    return TracedScene::build(scene, std::make_shared<Workers>(threads));
}

Light pointLight(Vec3 position, Vec3 diffuse)
{
    Light light;
    light.kind = LightKind::Point;
    light.position = position;
    light.diffuse = diffuse;
    light.attenuationConstant = 0.0f;
    light.attenuationQuadratic = 1.0f;
    return light;
}

SceneBuilder cornellBox(Vec3 offset)
{
    SceneBuilder box;
    const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 albedo)
    {
        box.add(newMesh({a + offset, b + offset, c + offset, d + offset}, {{0, 1, 2}, {0, 2, 3}}),
                lambert(albedo));
    };
    const auto block = [&](const Vec3(&base)[4], float height, Vec3 albedo)
    {
        const Vec3 up(0.0f, height, 0.0f);
        quad(base[0] + up, base[1] + up, base[2] + up, base[3] + up, albedo);
        for (std::size_t i = 0; i < 4; ++i)
        {
            const Vec3 a = base[i], b = base[(i + 1) % 4];
            quad(a, b, b + up, a + up, albedo);
        }
    };
    const auto light = [&](Vec3 corner, Vec3 edgeU, Vec3 edgeV, Vec3 radiance)
    { box.addQuadLight(corner + offset, edgeU, edgeV, radiance); };
    data::cornell::build<Vec3>(quad, block, light);
    return box;
}

View perspectiveView(Vec3d eye, Vec3d centre, Vec3d up, double fovyDegrees, int width, int height)
{
    View view;
    view.width = width;
    view.height = height;
    view.viewFromWorld = glm::lookAt(eye, centre, up);
    view.clipFromView =
        glm::perspective(glm::radians(fovyDegrees), double(width) / height, 0.01, 10000.0);
    return view;
}

View cornellView(int width, int height)
{
    return perspectiveView({278, 273, -800}, {278, 273, 0}, {0, 1, 0}, 39.3, width, height);
}

View patchView(Vec3d centre, Vec3d normal, double side, int pixels)
{
    View view;
    view.width = view.height = pixels;
    const Vec3d up = std::abs(normal.x) > 0.5 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
    view.viewFromWorld = glm::lookAt(centre + normal * side, centre, up);
    view.clipFromView =
        glm::ortho(-0.5 * side, 0.5 * side, -0.5 * side, 0.5 * side, 0.5 * side, 2.0 * side);
    return view;
}

Vec3 Picture::at(int x, int y) const
{
    const float* p = &rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x))];
    return Vec3(p[0], p[1], p[2]);
}

Vec3 Picture::mean() const
{
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        sum += Vec3d(rgba[i], rgba[i + 1], rgba[i + 2]);
    return Vec3(sum / (double(width) * height));
}

Picture render(const std::shared_ptr<const TracedScene>& scene, const View& view,
               const RenderOptions& options, int passes, int threads)
{
    RenderSession session(std::make_shared<Workers>(threads));
    session.setScene(scene);
    session.setView(view);
    session.setOptions(options);
    StopRule rule;
    rule.passes = passes;
    Picture picture;
    picture.progress = session.render(rule);
    picture.width = session.width();
    picture.height = session.height();
    picture.rgba = session.resolveRadiance();
    return picture;
}

RenderOptions optionsOf(IntegratorKind integrator, int maxBounces, uint32_t seed)
{
    RenderOptions options;
    options.integrator = integrator;
    options.maxBounces = maxBounces;
    options.seed = seed;
    return options;
}

} // namespace osgRayTrace::engine::test
