// SceneTraitsTest.cpp - all needs of a scene are found, and no others.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/integrators/IntegratorFactory.h"
#include "osgRayTrace/scene/SceneTraits.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

SceneTraits traitsOf(const Material& material)
{
    Scene scene;
    scene.materials = {material};
    return sceneTraits(scene);
}

} // namespace

TEST_CASE("scene traits: an empty scene needs nothing", "[scene]")
{
    const SceneTraits traits = sceneTraits(Scene());
    CHECK_FALSE(traits.instances);
    CHECK_FALSE(traits.smoothNormals);
    CHECK_FALSE(traits.textures);
    CHECK_FALSE(traits.fixedFunction);
    CHECK_FALSE(traits.physical);
    CHECK_FALSE(traits.deltaLights);
    CHECK_FALSE(traits.areaLights);
    CHECK(traits.triangles == 0);
}

TEST_CASE("scene traits: triangles count once for each instance", "[scene]")
{
    SceneBuilder builder;
    builder.add(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(0.5f)));
    Instance placed = builder.scene->instances[0];
    placed.placed = true;
    builder.scene->instances.push_back(placed);
    const SceneTraits traits = sceneTraits(*builder.scene);
    CHECK(traits.triangles == 4);
    CHECK(traits.instances);
}

TEST_CASE("scene traits: materials", "[scene]")
{
    CHECK(traitsOf(Material()).fixedFunction);
    CHECK_FALSE(traitsOf(Material()).physical);
    CHECK(traitsOf(lambert(Vec3(0.5f))).physical);
    CHECK_FALSE(traitsOf(lambert(Vec3(0.5f))).specular);
    CHECK_FALSE(traitsOf(lamp(Vec3(1.0f))).physical); // a lamp needs no path tracing
    CHECK(traitsOf(mirror(Vec3(1.0f))).specular);
    CHECK(traitsOf(glass(1.5f)).transmission);
    CHECK(traitsOf(glass(1.5f)).specular);
    CHECK_FALSE(traitsOf(glass(1.5f, 0.5f)).specular);
    Material metal = mirror(Vec3(1.0f));
    metal.roughness = 0.49f;
    CHECK(traitsOf(metal).glossy);
    CHECK_FALSE(traitsOf(metal).specular);
    metal.roughness = 0.51f;
    CHECK_FALSE(traitsOf(metal).glossy);
    CHECK_FALSE(traitsOf(glass(1.0f)).physical); // invisible

    Material black = lambert(Vec3(0.0f));
    CHECK_FALSE(traitsOf(black).physical);
    MaterialDetail leaf;
    leaf.diffuseTransmission = 0.5f;
    black.detail = std::make_shared<MaterialDetail>(leaf);
    CHECK(traitsOf(black).physical);
    CHECK_FALSE(traitsOf(black).specular);
    MaterialDetail film;
    film.iridescence = 1.0f;
    black.detail = std::make_shared<MaterialDetail>(film);
    black.roughness = 0.0f;
    CHECK(traitsOf(black).physical);
    CHECK(traitsOf(black).specular);
    CHECK_FALSE(traitsOf(glass(1.0f)).transmission);

    Material textured = lambert(Vec3(1.0f));
    CHECK_FALSE(traitsOf(textured).textures);
    textured.emissionTexture = 0;
    CHECK(traitsOf(textured).textures);
    Material colored;
    CHECK_FALSE(traitsOf(colored).vertexColors);
    colored.vertexColorUse = VertexColorUse::Diffuse;
    CHECK(traitsOf(colored).vertexColors);
}

TEST_CASE("scene traits: the mere boundary of a medium casts no caustics", "[scene]")
{
    // MediumVolumes of the shape BOX are such boundaries.
    MaterialDetail smoke;
    smoke.interior.sigmaS = Vec3(0.5f);
    Material boundary = glass(1.0f);
    boundary.detail = std::make_shared<MaterialDetail>(smoke);
    const SceneTraits traits = traitsOf(boundary);
    CHECK(traits.scattering);
    CHECK(traits.media);
    CHECK_FALSE(traits.transmission);
    CHECK_FALSE(traits.specular);
    // Bodies that bend or tint light block what lights send straight.
    boundary.ior = 1.3f;
    CHECK(traitsOf(boundary).transmission);
    boundary.ior = 1.0f;
    boundary.baseColor = Vec3(0.9f);
    CHECK(traitsOf(boundary).transmission);

    const auto chosen = [&](const Material& material)
    {
        SceneBuilder builder;
        builder.add(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(0.5f)));
        builder.add(quadMesh({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), material);
        builder.addQuadLight({0, 0, 2}, {0, 1, 0}, {1, 0, 0}, Vec3(1.0f));
        return chooseIntegrator(IntegratorKind::Automatic, sceneTraits(*builder.scene));
    };
    CHECK(chosen(boundary) == IntegratorKind::PhotonCaustics);
    boundary.baseColor = Vec3(1.0f);
    CHECK(chosen(boundary) == IntegratorKind::Path);
}

TEST_CASE("scene traits: mips count where a material looks them up", "[scene]")
{
    Scene scene;
    const auto texture = std::make_shared<Texture>();
    texture->mips.resize(1);
    scene.textures = {texture, std::make_shared<Texture>()};
    const auto mipmapped = [&scene](const Material& material)
    {
        scene.materials = {material};
        return sceneTraits(scene).mipmaps;
    };
    Material material = lambert(Vec3(1.0f));
    CHECK_FALSE(mipmapped(material));
    material.baseColorTexture = 1;
    CHECK_FALSE(mipmapped(material));
    MaterialDetail detail;
    detail.textures[kNormalRole] = 0;
    material.detail = std::make_shared<MaterialDetail>(detail);
    CHECK_FALSE(mipmapped(material)); // normal maps are never looked up in mips
    detail.textures[kIridescenceRole] = 0;
    material.detail = std::make_shared<MaterialDetail>(detail);
    CHECK(mipmapped(material));
    material = lambert(Vec3(1.0f));
    material.baseColorTexture = 0;
    CHECK(mipmapped(material));
    material = Material();
    material.second.texture = 0;
    CHECK(mipmapped(material));
}

TEST_CASE("scene traits: lights and normals", "[scene]")
{
    SceneBuilder builder;
    builder.addLight(pointLight(Vec3(0.0f)));
    CHECK(sceneTraits(*builder.scene).deltaLights);
    CHECK_FALSE(sceneTraits(*builder.scene).areaLights);
    builder.addQuadLight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1.0f));
    CHECK(sceneTraits(*builder.scene).areaLights);
    CHECK_FALSE(sceneTraits(*builder.scene).smoothNormals);
    auto smooth = quadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    smooth->normals = std::vector<Vec3>(4, Vec3(0, 0, 1));
    builder.add(smooth, lambert(Vec3(0.5f)));
    CHECK(sceneTraits(*builder.scene).smoothNormals);
}

TEST_CASE("integrator: automatic takes the cheapest that is right for the scene", "[scene]")
{
    SceneTraits fixed;
    fixed.fixedFunction = true;
    SceneTraits physical;
    physical.physical = true;
    CHECK(chooseIntegrator(IntegratorKind::Automatic, fixed) == IntegratorKind::Whitted);
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::Path);
    physical.specular = true; // surfaces reflect, and transmit no light
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::Path);
    physical.areaLights = true;
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::PhotonCaustics);
    physical.specular = false;
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::Path);
    physical.glossy = true; // a lamp or a sun makes caustics, a sky smooth light
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::PhotonCaustics);
    physical.areaLights = false;
    physical.environment = true;
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::Path);
    physical.deltaLights = true;
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::PhotonCaustics);
    physical.glossy = physical.environment = physical.deltaLights = false;
    physical.areaLights = true;
    physical.transmission = true;
    CHECK(chooseIntegrator(IntegratorKind::Automatic, physical) == IntegratorKind::PhotonCaustics);
    CHECK(chooseIntegrator(IntegratorKind::Path, physical) == IntegratorKind::Path);
    CHECK(chooseIntegrator(IntegratorKind::Whitted, physical) == IntegratorKind::Whitted);
    CHECK(chooseIntegrator(IntegratorKind::Debug, fixed) == IntegratorKind::Debug);
}
