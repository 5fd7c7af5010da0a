// BsdfKinds.cpp - every kind of surface that the Bsdf can be, with ordinary and extreme parameters.
// SPDX-License-Identifier: MIT
#include "tests/shading/BsdfKinds.h"

#include "osgRayTrace/shading/MaterialTable.h"

#include <cmath>
#include <list>
#include <memory>

namespace osgRayTrace::engine::test
{

namespace
{

Bsdf bsdfOf(const Material& material, bool front)
{
    static std::list<std::pair<Scene, std::unique_ptr<MaterialTable>>>
        tables; // own the coats' reflectances
    tables.emplace_back();
    auto& [scene, table] = tables.back();
    scene.materials = {material};
    table = std::make_unique<MaterialTable>(scene);
    MaterialPoint point;
    point.front = front;
    return table->bsdf(0, point);
}

Material physical(float roughness, float metallic, float transmission, float ior)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.roughness = roughness;
    material.metallic = metallic;
    material.transmission = transmission;
    material.ior = ior;
    return material;
}

Material phong(float specular, float shininess, float diffuse = 1.0f)
{
    Material material;
    material.diffuse = Vec3(diffuse);
    material.specular = Vec3(specular);
    material.shininess = shininess;
    return material;
}

void add(std::vector<BsdfKind>& kinds, const std::string& name, const Material& material)
{
    kinds.push_back({name, bsdfOf(material, true)});
    if (material.transmission > 0.0f)
        kinds.push_back({name + ", from inside", bsdfOf(material, false)});
}

std::vector<BsdfKind> kindsOfRoughness(const std::vector<float>& roughnesses)
{
    std::vector<BsdfKind> kinds;
    for (const float roughness : roughnesses)
    {
        const std::string rough = "roughness " + std::to_string(roughness);
        add(kinds, rough + ", metal", physical(roughness, 1.0f, 0.0f, 1.5f));
        for (const float ior : {1.0001f, 1.5f, 3.0f})
        {
            const std::string index = rough + ", index " + std::to_string(ior);
            add(kinds, index + ", plastic", physical(roughness, 0.0f, 0.0f, ior));
            add(kinds, index + ", glass", physical(roughness, 0.0f, 1.0f, ior));
        }
    }
    return kinds;
}

} // namespace

std::vector<BsdfKind> kindsOf(float roughness, float transmission, float ior)
{
    std::vector<BsdfKind> kinds;
    add(kinds, "roughness " + std::to_string(roughness),
        physical(roughness, 0.0f, transmission, ior));
    return kinds;
}

std::vector<BsdfKind> extremeKinds()
{
    return kindsOfRoughness({0.0317f, 0.1f, 1.0f});
}

std::vector<BsdfKind> extremeSmoothKinds()
{
    return kindsOfRoughness({0.0f, 1e-3f, 0.01f, 0.0316f});
}

std::vector<BsdfKind> roughKinds()
{
    std::vector<BsdfKind> kinds;
    add(kinds, "lambert", physical(1.0f, 0.0f, 0.0f, 1.0f));
    add(kinds, "plastic", physical(0.5f, 0.0f, 0.0f, 1.5f));
    add(kinds, "rough plastic", physical(1.0f, 0.0f, 0.0f, 1.5f));
    add(kinds, "glossy plastic, high index", physical(0.1f, 0.0f, 0.0f, 2.4f));
    add(kinds, "metal, rough", physical(1.0f, 1.0f, 0.0f, 1.5f));
    add(kinds, "metal, medium", physical(0.5f, 1.0f, 0.0f, 1.5f));
    add(kinds, "metal, barely rough", physical(0.034f, 1.0f, 0.0f, 1.5f));
    add(kinds, "half metal", physical(0.4f, 0.5f, 0.0f, 1.5f));
    add(kinds, "rough glass", physical(0.5f, 0.0f, 1.0f, 1.5f));
    add(kinds, "very rough glass", physical(1.0f, 0.0f, 1.0f, 1.5f));
    add(kinds, "barely rough glass", physical(0.05f, 0.0f, 1.0f, 1.5f));
    add(kinds, "rough diamond", physical(0.3f, 0.0f, 1.0f, 2.4f));
    add(kinds, "rough glass, nearly air", physical(0.5f, 0.0f, 1.0f, 1.02f));
    add(kinds, "half clear plastic", physical(0.4f, 0.0f, 0.5f, 1.5f));
    add(kinds, "everything at once", physical(0.4f, 0.3f, 0.5f, 1.5f));
    add(kinds, "phong, broad", phong(0.5f, 4.0f));
    add(kinds, "phong, sharp", phong(1.0f, 128.0f));
    add(kinds, "phong, shininess 0", phong(1.0f, 0.0f));
    add(kinds, "phong, dark and broad", phong(1.0f, 1.0f, 0.2f));
    add(kinds, "phong, black", phong(1.0f, 12.0f, 0.0f));
    return kinds;
}

std::vector<BsdfKind> smoothKinds()
{
    std::vector<BsdfKind> kinds;
    add(kinds, "mirror", physical(0.0f, 1.0f, 0.0f, 1.5f));
    add(kinds, "smooth plastic", physical(0.0f, 0.0f, 0.0f, 1.5f));
    add(kinds, "smooth glass", physical(0.0f, 0.0f, 1.0f, 1.5f));
    add(kinds, "smooth half glass", physical(0.0f, 0.2f, 0.5f, 1.5f));
    add(kinds, "air", physical(0.0f, 0.0f, 1.0f, 1.0f));
    return kinds;
}

std::vector<BsdfKind> allKinds()
{
    std::vector<BsdfKind> kinds = roughKinds();
    for (BsdfKind& kind : smoothKinds())
        kinds.push_back(kind);
    return kinds;
}

std::vector<BsdfKind> kindsOf(const std::string& name, const Material& material)
{
    std::vector<BsdfKind> kinds;
    add(kinds, name, material);
    return kinds;
}

std::vector<BsdfKind> layeredKinds()
{
    std::vector<BsdfKind> kinds;
    const auto with = [&kinds](const std::string& name, Material material, const auto& change)
    {
        MaterialDetail detail;
        change(detail);
        material.detail = std::make_shared<MaterialDetail>(detail);
        add(kinds, name, material);
    };
    const Material plastic = physical(0.6f, 0.0f, 0.0f, 1.5f);
    for (const float roughness : {0.0f, 0.3f, 1.0f})
    {
        const std::string coat = ", coat of roughness " + std::to_string(roughness);
        const auto coated = [roughness](MaterialDetail& d)
        {
            d.clearcoat = 1.0f;
            d.clearcoatRoughness = roughness;
        };
        with("plastic" + coat, plastic, coated);
        with("mirror" + coat, physical(0.0f, 1.0f, 0.0f, 1.5f), coated);
        with("metal" + coat, physical(0.4f, 1.0f, 0.0f, 1.5f), coated);
        with("glass" + coat, physical(0.4f, 0.0f, 1.0f, 1.5f), coated);
        with("half clear" + coat, physical(0.4f, 0.0f, 0.5f, 1.5f), coated);
    }
    for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
        with("sheen of roughness " + std::to_string(roughness), plastic,
             [roughness](MaterialDetail& d)
             {
                 d.sheenColor = Vec3(1.0f);
                 d.sheenRoughness = roughness;
             });
    for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f})
        with("thin wall of roughness " + std::to_string(roughness),
             physical(roughness, 0.0f, 1.0f, 1.5f), [](MaterialDetail& d) { d.thinWalled = true; });
    with("half clear thin wall", physical(0.4f, 0.0f, 0.5f, 1.5f),
         [](MaterialDetail& d) { d.thinWalled = true; });
    with("specular 0", plastic, [](MaterialDetail& d) { d.specular = 0.0f; });
    with("specular 0.5, smooth", physical(0.0f, 0.0f, 0.0f, 1.5f),
         [](MaterialDetail& d) { d.specular = 0.5f; });
    with("bright specular colour", plastic,
         [](MaterialDetail& d) { d.specularColor = Vec3(9.0f); });
    with("dark specular colour", plastic, [](MaterialDetail& d) { d.specularColor = Vec3(0.1f); });
    with("glass, bright specular colour", physical(0.3f, 0.0f, 1.0f, 1.5f),
         [](MaterialDetail& d) { d.specularColor = Vec3(4.0f); });
    with("everything", physical(0.5f, 0.3f, 0.4f, 1.7f),
         [](MaterialDetail& d)
         {
             d.clearcoat = 0.6f;
             d.clearcoatRoughness = 0.2f;
             d.sheenColor = Vec3(0.5f);
             d.sheenRoughness = 0.4f;
             d.specular = 0.7f;
             d.specularColor = Vec3(2.0f);
         });
    for (const float roughness : {0.1f, 0.5f})
    {
        const auto brushed = [](MaterialDetail& d)
        {
            d.anisotropy = 0.8f;
            d.anisotropyRotation = 0.6f;
        };
        const std::string rough = "brushed, of roughness " + std::to_string(roughness);
        with(rough + ", metal", physical(roughness, 1.0f, 0.0f, 1.5f), brushed);
        if (roughness < 0.2f) continue;
        with(rough + ", plastic", physical(roughness, 0.0f, 0.0f, 1.5f), brushed);
        with(rough + ", half clear", physical(roughness, 0.0f, 0.5f, 1.5f), brushed);
    }
    for (const float roughness : {0.0f, 0.5f})
    {
        const std::string rough = " of roughness " + std::to_string(roughness);
        const Material dielectric = physical(roughness, 0.0f, 0.0f, 1.5f);
        with("leaf" + rough, dielectric, [](MaterialDetail& d) { d.diffuseTransmission = 0.6f; });
        const auto film = [](MaterialDetail& d)
        {
            d.iridescence = 1.0f;
            d.iridescenceIor = 1.8f;
        };
        with("film on plastic" + rough, dielectric, film);
        with("film on white of index 1" + rough, physical(roughness, 0.0f, 0.0f, 1.0f), film);
        if (roughness == 0.0f) continue;
        with("film on metal" + rough, physical(roughness, 1.0f, 0.0f, 1.5f), film);
        with("film on glass" + rough, physical(roughness, 0.0f, 1.0f, 1.5f), film);
    }
    with("lacquered leaf, brushed, with film", physical(0.4f, 0.1f, 0.0f, 1.5f),
         [](MaterialDetail& d)
         {
             d.diffuseTransmission = 0.4f;
             d.clearcoat = 0.5f;
             d.clearcoatRoughness = 0.3f;
             d.anisotropy = 0.5f;
             d.iridescence = 0.7f;
         });
    return kinds;
}

std::vector<Vec3> outgoingDirections()
{
    std::vector<Vec3> directions{Vec3(0.0f, 0.0f, 1.0f)};
    for (const double cosine : {0.95, 0.6, 0.3, 0.05})
    {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        directions.emplace_back(sine * std::cos(0.7), sine * std::sin(0.7), cosine);
    }
    return directions;
}

std::vector<Vec3> grazingDirections()
{
    std::vector<Vec3> directions{Vec3(0.0f, 0.0f, 1.0f)};
    for (const double degrees : {60.0, 85.0, 89.0, 89.9})
    {
        const double theta = degrees * M_PI / 180.0;
        directions.emplace_back(std::sin(theta) * std::cos(0.7), std::sin(theta) * std::sin(0.7),
                                std::cos(theta));
    }
    return directions;
}

} // namespace osgRayTrace::engine::test
