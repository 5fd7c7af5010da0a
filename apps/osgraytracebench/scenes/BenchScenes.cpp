// BenchScenes.cpp - builds meshes, lights and views by formula. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/scenes/BenchScenes.h"

#include "data/generator/CornellBoxTable.h"

#include <glm/gtc/matrix_transform.hpp>

#include <osg/Array>
#include <osg/PrimitiveSet>

#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

uint32_t addDiffuse(Scene& scene, Vec3 albedo)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.baseColor = albedo;
    material.ior = 1.0f;
    scene.materials.push_back(material);
    return static_cast<uint32_t>(scene.materials.size() - 1);
}

void addQuad(Scene& scene, Vec3 a, Vec3 b, Vec3 c, Vec3 d, uint32_t material,
             uint32_t light = kInvalid)
{
    auto mesh = std::make_shared<Mesh>();
    std::vector<Vec3> positions;
    positions.reserve(5); // Embree reads past the last one
    positions.insert(positions.end(), {a, b, c, d});
    mesh->positions = std::move(positions);
    mesh->triangles = std::vector<UVec3>{{0, 1, 2}, {0, 2, 3}};
    Instance instance;
    instance.mesh = static_cast<uint32_t>(scene.meshes.size());
    instance.material = material;
    instance.light = light;
    scene.meshes.push_back(mesh);
    scene.instances.push_back(instance);
}

void addBlock(Scene& scene, const Vec3 (&base)[4], float height, uint32_t material)
{
    const Vec3 up(0.0f, height, 0.0f);
    addQuad(scene, base[0] + up, base[1] + up, base[2] + up, base[3] + up, material);
    for (int i = 0; i < 4; ++i)
    {
        const Vec3 a = base[i], b = base[(i + 1) % 4];
        addQuad(scene, a, b, b + up, a + up, material);
    }
}

void addLight(Scene& scene, Vec3 corner, Vec3 edgeU, Vec3 edgeV, Vec3 radiance)
{
    const uint32_t material = addDiffuse(scene, Vec3(0.0f));
    scene.materials[material].emission = radiance;
    Light light;
    light.kind = LightKind::Parallelogram;
    light.corner = corner;
    light.edgeU = edgeU;
    light.edgeV = edgeV;
    light.radiance = radiance;
    light.instance = static_cast<uint32_t>(scene.instances.size());
    addQuad(scene, corner, corner + edgeU, corner + edgeU + edgeV, corner + edgeV, material,
            static_cast<uint32_t>(scene.lights.size()));
    scene.lights.push_back(light);
}

View viewOf(Vec3d eye, Vec3d centre, Vec3d up, double fovyDegrees, int width, int height)
{
    View view;
    view.width = width;
    view.height = height;
    view.viewFromWorld = glm::lookAt(eye, centre, up);
    view.clipFromView =
        glm::perspective(glm::radians(fovyDegrees), double(width) / height, 0.01, 10000.0);
    return view;
}

} // namespace

BenchScene cornellBox(int width, int height)
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    const uint32_t white = addDiffuse(*scene, data::cornell::kWhite.as<Vec3>());
    const uint32_t red = addDiffuse(*scene, data::cornell::kRed.as<Vec3>());
    const uint32_t green = addDiffuse(*scene, data::cornell::kGreen.as<Vec3>());
    const auto materialOf = [&](Vec3 albedo) {
        return albedo.x == albedo.y ? white : albedo.x > albedo.y ? red : green;
    };
    data::cornell::build<Vec3>([&](Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 albedo)
                               { addQuad(*scene, a, b, c, d, materialOf(albedo)); },
                               [&](const Vec3(&base)[4], float blockHeight, Vec3 albedo)
                               { addBlock(*scene, base, blockHeight, materialOf(albedo)); },
                               [&](Vec3 corner, Vec3 edgeU, Vec3 edgeV, Vec3 radiance)
                               { addLight(*scene, corner, edgeU, edgeV, radiance); });
    // The published view is square; a view from inside the box fills a wide frame as well.
    return {scene, viewOf({278, 278, 20}, {278, 250, 559}, {0, 1, 0}, 50.0, width, height)};
}

osg::ref_ptr<osg::Geometry> displacedSphereGeometry()
{
    constexpr int kRows = 500, kColumns = 1000;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    positions->reserve((kRows + 1) * (kColumns + 1) + 1);
    const auto point = [](double theta, double phi)
    {
        const double radius = 1.0 + 0.02 * std::sin(40.0 * theta) * std::sin(40.0 * phi);
        return osg::Vec3d(radius * std::sin(theta) * std::cos(phi),
                          radius * std::sin(theta) * std::sin(phi), radius * std::cos(theta));
    };
    for (int row = 0; row <= kRows; ++row)
    {
        for (int column = 0; column <= kColumns; ++column)
        {
            const double theta = osg::PI * (row + 0.25) / (kRows + 0.5),
                         phi = 2.0 * osg::PI * column / kColumns;
            const osg::Vec3d p = point(theta, phi);
            osg::Vec3d n = (point(theta + 1e-4, phi) - p) ^ (point(theta, phi + 1e-4) - p);
            n.normalize();
            positions->push_back(p);
            normals->push_back(n);
        }
    }
    for (unsigned row = 0; row < kRows; ++row)
    {
        for (unsigned column = 0; column < kColumns; ++column)
        {
            const unsigned a = row * (kColumns + 1) + column, b = a + kColumns + 1;
            for (const unsigned index : {a, b, a + 1, a + 1, b, b + 1})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles);
    return geometry;
}

BenchScene displacedSphere(int width, int height)
{
    auto scene = std::make_shared<Scene>();
    scene->displayReferred = false;
    const uint32_t grey = addDiffuse(*scene, Vec3(0.7f));
    const osg::ref_ptr<osg::Geometry> geometry = displacedSphereGeometry();
    const auto& p = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
    const auto& n = static_cast<const osg::Vec3Array&>(*geometry->getNormalArray());
    const auto& t = static_cast<const osg::DrawElementsUInt&>(*geometry->getPrimitiveSet(0));
    std::vector<Vec3> positions, normals;
    std::vector<UVec3> triangles;
    positions.reserve(p.size() + 1);
    for (std::size_t i = 0; i < p.size(); ++i)
    {
        positions.emplace_back(p[i].x(), p[i].y(), p[i].z());
        normals.emplace_back(n[i].x(), n[i].y(), n[i].z());
    }
    for (std::size_t i = 0; i + 2 < t.size(); i += 3)
        triangles.emplace_back(t[i], t[i + 1], t[i + 2]);
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = std::move(positions);
    mesh->normals = std::move(normals);
    mesh->triangles = std::move(triangles);
    Instance instance;
    instance.material = grey;
    scene->meshes.push_back(mesh);
    scene->instances.push_back(instance);
    // The light is behind and below the viewer, turned towards the sphere: edgeU x edgeV = (0, 4.5,
    // 4.5).
    addLight(*scene, {-1.5f, -4.0f, -2.0f}, {3, 0, 0}, {0, 1.5f, -1.5f}, Vec3(12.0f));
    return {scene, viewOf({0.0, -2.2, 0.0}, {0, 0, 0}, {0, 0, 1}, 30.0, width, height)};
}

} // namespace osgRayTrace::bench
