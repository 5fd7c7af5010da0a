// GlossyCasterTest.cpp - brushed metal and rough glass cast their light by photons, each path once.
// SPDX-License-Identifier: MIT
#include "tests/Environments.h"
#include "tests/PValues.h"
#include "tests/photons/PhotonMeans.h"
#include "tests/statistics/TenScenes.h"

#include "osgRayTrace/photons/PhotonTracer.h"
#include "osgRayTrace/shading/TextureMips.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kBounces = 12;
constexpr int kPathPasses = 48, kPhotonPasses = 16; ///< of 24 x 24 pixels

Material brushed(float roughness)
{
    Material material = mirror(Vec3(0.95f, 0.9f, 0.8f));
    material.roughness = roughness;
    return material;
}

/// Returns a floor and two walls without a light.
SceneBuilder darkRoom()
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.6f)));
    builder.add(quadMesh({-2, 1.5f, 0}, {4, 0, 0}, {0, 0, 3}), lambert(Vec3(0.3f, 0.5f, 0.7f)));
    builder.add(quadMesh({-2, -2, 0}, {0, 4, 0}, {0, 0, 3}), lambert(Vec3(0.7f, 0.5f, 0.3f)));
    return builder;
}

/// Adds a lamp so large that paths find it by chance after a mirror.
void addLamp(SceneBuilder& builder)
{
    builder.addQuadLight({-1.1f, -1.1f, 2.6f}, {0, 2.2f, 0}, {2.2f, 0, 0}, Vec3(2.0f));
}

/// Adds an area light, a spot and a sun that hit what stands in the room more than its walls.
void addLights(SceneBuilder& builder)
{
    builder.addQuadLight({0.4f, -1.4f, 2.4f}, {0, 0.6f, 0.3f}, {0.6f, 0, 0.2f}, Vec3(6.0f));
    Light spot = pointLight({-0.8f, -1.4f, 2.2f}, Vec3(1.5f, 2.0f, 1.5f));
    spot.direction = glm::normalize(Vec3(0.2f, 1.2f, -1.4f));
    spot.spotCosCutoff = std::cos(0.35f);
    spot.number = 0;
    builder.addLight(spot);
    Light sun;
    sun.kind = LightKind::Directional;
    sun.diffuse = Vec3(0.2f);
    sun.direction = glm::normalize(Vec3(-0.3f, 0.7f, -1.0f));
    sun.number = 1;
    builder.addLight(sun);
}

SceneBuilder metalBoxes()
{
    SceneBuilder builder = darkRoom();
    int k = 0;
    for (const float roughness : {0.25f, 0.35f, 0.49f})
    {
        const float x = -1.3f + 0.9f * float(k++);
        builder.add(boxMesh({x, 0.1f, 0}, {x + 0.6f, 0.6f, 0.9f}), brushed(roughness));
    }
    addLights(builder);
    return builder;
}

SceneBuilder roughGlass()
{
    SceneBuilder builder = darkRoom();
    builder.add(sphereMesh({-0.6f, 0, 0.7f}, 0.5f, 24), glass(1.5f, 0.35f));
    builder.add(boxMesh({0.2f, -0.4f, 0.1f}, {1.0f, 0.1f, 1.0f}), glass(1.3f, 0.45f));
    addLights(builder);
    return builder;
}

/// Returns metal below coats, of which one is a mirror; a coated Lambert surface, which is no
/// caster; and a thin wall.
SceneBuilder coats()
{
    SceneBuilder builder = darkRoom();
    Material smooth = brushed(0.35f);
    MaterialDetail detail;
    detail.clearcoat = 1.0f;
    smooth.detail = std::make_shared<MaterialDetail>(detail);
    builder.add(boxMesh({-1.3f, 0.1f, 0}, {-0.7f, 0.6f, 0.9f}), smooth);
    Material rough = brushed(0.0f);
    detail.clearcoatRoughness = 0.35f;
    rough.detail = std::make_shared<MaterialDetail>(detail);
    builder.add(boxMesh({-0.4f, 0.1f, 0}, {0.2f, 0.6f, 0.9f}), rough);
    Material plastic = lambert(Vec3(0.5f, 0.3f, 0.3f));
    plastic.ior = 1.8f;
    plastic.roughness = 0.3f;
    builder.add(boxMesh({0.5f, 0.1f, 0}, {1.1f, 0.6f, 0.9f}), plastic);
    Material thin = glass(1.5f, 0.35f);
    MaterialDetail wall;
    wall.thinWalled = true;
    thin.detail = std::make_shared<MaterialDetail>(wall);
    builder.add(quadMesh({-0.3f, -0.6f, 0.2f}, {1.0f, 0, 0}, {0, 0.3f, 0.8f}), thin);
    addLamp(builder);
    return builder;
}

/// Returns plates whose texture makes them metal of this and of twice this width, and plaster.
SceneBuilder textured()
{
    SceneBuilder builder = darkRoom();
    auto checks = std::make_shared<Texture>();
    checks->width = checks->height = 8;
    for (int i = 0; i < 64; ++i)
    {
        const int kind = (i % 8 / 2 + i / 16) % 3;
        const float roughness = kind == 0 ? 0.3f : 0.6f, metallic = kind == 2 ? 0.0f : 1.0f;
        for (const float c : {0.0f, roughness, metallic, 1.0f})
            checks->floats.push_back(c);
    }
    checks->mips = textureMips(*checks, true);
    builder.scene->textures = {checks};
    Material plate = brushed(1.0f);
    plate.metallicRoughnessTexture = 0;
    // The floor takes photons, but mirrors the plates with their mips to paths that have taken
    // none.
    Material coated = lambert(Vec3(0.5f));
    coated.ior = 2.0f;
    coated.roughness = 0.0f;
    builder.add(quadMesh({-1.8f, -1.8f, 0.01f}, {3.6f, 0, 0}, {0, 3.2f, 0}), coated);
    for (const float x : {-1.3f, 0.2f})
    {
        auto mesh = quadMesh({x, 0.2f, 0.1f}, {1.1f, 0, 0}, {0, 0.6f, 1.0f});
        mesh->uvs = std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
        builder.add(mesh, plate);
    }
    addLamp(builder);
    return builder;
}

/// Returns mirrors, clear and rough bodies in each other's light.
SceneBuilder chains()
{
    SceneBuilder builder = darkRoom();
    builder.add(quadMesh({1.9f, 1.4f, 0}, {0, -3, 0}, {0, 0, 2}), mirror(Vec3(0.9f)));
    builder.add(boxMesh({-1.2f, 0, 0}, {-0.5f, 0.6f, 0.9f}), brushed(0.3f));
    builder.add(sphereMesh({0.3f, -0.2f, 0.6f}, 0.4f, 24), glass(1.5f));
    builder.add(sphereMesh({1.1f, 0.3f, 0.5f}, 0.4f, 24), glass(1.5f, 0.4f));
    addLamp(builder);
    return builder;
}

SceneBuilder underSky()
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.7f)));
    builder.add(boxMesh({-1.2f, -0.3f, 0}, {-0.5f, 0.3f, 0.9f}), brushed(0.35f));
    builder.add(sphereMesh({0.5f, 0, 0.6f}, 0.5f, 24), glass(1.5f, 0.4f));
    builder.addLight(environmentLight(sunnySky(16, 8), tilted(0.3f)));
    return builder;
}

/// Returns faces that exist from one side, under lights that nothing hides.
SceneBuilder oneSided()
{
    SceneBuilder builder = darkRoom();
    builder.add(boxMesh({-1.2f, 0, 0}, {-0.4f, 0.5f, 0.9f}), brushed(0.35f));
    builder.add(sphereMesh({0.6f, 0, 0.6f}, 0.5f, 24), glass(1.5f, 0.4f));
    for (Material& material : builder.scene->materials)
    {
        material.culling = FaceCulling::Back;
        material.cullsAllRays = true;
    }
    addLights(builder);
    for (Light& light : builder.scene->lights)
        if (light.kind == LightKind::Directional) light.castsShadows = false;
    return builder;
}

std::vector<ComparedScene> casterScenes()
{
    const View view = perspectiveView({0.4, -4, 2}, {0, 0, 0.6}, {0, 0, 1}, 40.0, 24, 24);
    return {{"metal", metalBoxes().build(), view},  {"rough glass", roughGlass().build(), view},
            {"coats", coats().build(), view},       {"textured", textured().build(), view},
            {"chains", chains().build(), view},     {"under a sky", underSky().build(), view},
            {"one-sided", oneSided().build(), view}};
}

} // namespace

TEST_CASE("photons and paths agree: glossy casters", "[photons][statistics]")
{
    // All comparisons together raise a false alarm with a probability of 1 %.
    const std::vector<ComparedScene> scenes = casterScenes();
    const double threshold = sidak(0.01, 2 * static_cast<int>(scenes.size()));
    for (const ComparedScene& scene : scenes)
    {
        RenderOptions options = optionsOf(IntegratorKind::Path, kBounces);
        const Estimate path = meanOf(scene.traced, scene.view, options, kPathPasses);
        CHECK(path.standardError() < 4e-3 * path.mean());
        for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
        {
            options.integrator = kind;
            options.photons = 6000;
            const bool caustics = kind == IntegratorKind::PhotonCaustics;
            options.photonRadius = caustics ? 0.03f : 0.016f;
            const Estimate photons = meanOf(scene.traced, scene.view, options, kPhotonPasses);
            const double p = welchTest(path, kRuns, photons, kRuns);
            CAPTURE(scene.name, int(kind), path.mean(), path.standardError(), photons.mean(),
                    photons.standardError(), p, threshold);
            CHECK(photons.standardError() < (caustics ? 3e-3 : 0.015) * path.mean());
            CHECK(p > threshold);
        }
    }
}

TEST_CASE("photons: glossy surfaces keep those that mirrors alone have sent", "[photons]")
{
    // A mirror and a glossy plate send light of one spot each to the other and to the floor.
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({-1, -1, 0.1f}, {0, 2, 0}, {0, 0, 2}), mirror(Vec3(0.9f)));
    const float plate = 1.0f;
    builder.add(quadMesh({plate, 1, 0.1f}, {0, -2, 0}, {0, 0, 2}), brushed(0.2f));
    for (const float side : {-1.0f, 1.0f})
    {
        Light spot = pointLight({0, 0, 1.6f});
        spot.direction = glm::normalize(Vec3(side, 0, -0.4f));
        spot.spotCosCutoff = std::cos(0.2f);
        builder.addLight(spot);
    }
    const auto traced = builder.build();
    PhotonPassOptions options;
    options.photons = 20000;
    for (const PhotonUse use : {PhotonUse::Caustics, PhotonUse::Indirect})
    {
        options.use = use;
        const PhotonEmitter emitter(*traced, traced->scene().lights, 0.5f);
        PhotonMemory memory;
        const TracedPhotons traces =
            tracePhotons(*traced, traced->scene().lights, emitter, options, 0, Workers(2), memory);
        std::size_t mirrored = 0, others = 0, onFloor = 0;
        for (const Photon& photon : listOf(traces.photons.spans()))
        {
            const bool onPlate = photon.position.x > plate - 1e-3f && photon.normal.z < 0.5f;
            mirrored += onPlate && photon.direct;
            others += onPlate && !photon.direct;
            onFloor += photon.position.z < 1e-3f && !photon.direct;
        }
        CAPTURE(int(use));
        CHECK((mirrored > 100) == (use == PhotonUse::Caustics));
        CHECK(others == 0);
        CHECK(onFloor > 1000); // from the plate
    }
}

TEST_CASE("photon targets: what is glossy, and nothing rougher", "[photons]")
{
    SceneBuilder builder = darkRoom();
    const Vec3 glossy(-1, 0, 1), clear(1, 0, 1), rough(0, 0, 2);
    builder.add(sphereMesh(glossy, 0.3f, 12), brushed(0.45f));
    builder.add(sphereMesh(clear, 0.4f, 12), glass(1.5f, 0.45f));
    builder.add(sphereMesh(rough, 0.2f, 12), brushed(0.55f));
    const auto traced = builder.build();
    const PhotonTargets targets = photonTargets(*traced, PhotonUse::Caustics, 8);
    REQUIRE(targets.spheres.size() == 2);
    CHECK(glm::length(targets.spheres[0].centre - glossy) < 1e-4f);
    CHECK(glm::length(targets.spheres[1].centre - clear) < 1e-4f);
    CHECK(targets.spheres[1].radius < 0.401f);
    CHECK(photonTargets(*traced, PhotonUse::Indirect, 8).spheres.empty());
}
