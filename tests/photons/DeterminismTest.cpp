// DeterminismTest.cpp - photon pictures depend on the seed alone, even with a single photon or with
// millions in one place.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/photons/PhotonPasses.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr IntegratorKind kKinds[] = {IntegratorKind::Ppm, IntegratorKind::Sppm,
                                     IntegratorKind::PhotonCaustics};

/// Returns a scene of glass, metal and diffuse surfaces with lights with and without area.
/// roughness: of the metal.
SceneBuilder stage(float roughness = 0.6f)
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.7f)));
    builder.add(sphereMesh({-0.5f, 0, 0.6f}, 0.5f, 16), glass(1.5f));
    Material metal = mirror(Vec3(0.8f, 0.7f, 0.5f));
    metal.roughness = roughness;
    builder.add(boxMesh({0.3f, -0.4f, 0}, {0.9f, 0.2f, 0.8f}), metal);
    builder.addQuadLight({-0.4f, -0.4f, 2.5f}, {0, 0.8f, 0}, {0.8f, 0, 0}, Vec3(3.0f));
    builder.addEmissive(sphereMesh({1.2f, 0.8f, 1.5f}, 0.2f, 6), lamp(Vec3(1, 2, 3)));
    builder.addLight(pointLight({-1, -1, 1.5f}, Vec3(0.3f)));
    return builder;
}

View stageView(int size = 40)
{
    return perspectiveView({0.4, -4, 2}, {0, 0, 0.6}, {0, 0, 1}, 40.0, size, size);
}

} // namespace

TEST_CASE("photon pictures: equal for 1, 2 and 5 threads, bit by bit, and beside other views",
          "[photons][stability 50]")
{
    for (const IntegratorKind kind : kKinds)
        for (const RadiusSchedule schedule : {RadiusSchedule::Global, RadiusSchedule::Local})
        {
            RenderOptions options = optionsOf(kind);
            options.photons = 7000; // several chunks, the last of which is not full
            options.radiusSchedule = schedule;
            CAPTURE(int(kind), int(schedule));
            const Picture first = render(stage().build(1), stageView(), options, 4, 1);
            REQUIRE(first.mean().y > 0.05f);
            for (const int threads : {1, 2, 5})
            {
                const Picture again =
                    render(stage().build(threads), stageView(), options, 4, threads);
                CAPTURE(threads);
                const bool same = again.rgba == first.rgba;
                CHECK(same);
                CHECK(again.progress.rays.photon == first.progress.rays.photon);
            }
            options.seed = 1;
            const bool seedMatters =
                render(stage().build(1), stageView(), options, 4, 1).rgba != first.rgba;
            CHECK(seedMatters);
            options.seed = 0;

            // Another view of the same scene is one pass ahead, and its photons are used.
            const auto traced = stage().build(2);
            const auto workers = std::make_shared<Workers>(2);
            const auto photons = std::make_shared<PhotonPasses>();
            RenderSession other(workers, photons), session(workers, photons);
            for (RenderSession* s : {&other, &session})
            {
                s->setScene(traced);
                s->setOptions(options);
                s->setView(stageView(s == &other ? 24 : 40));
            }
            for (int pass = 1; pass <= 4; ++pass)
                for (RenderSession* s : {&other, &session})
                {
                    StopRule rule;
                    rule.passes = s == &other ? pass + 1 : pass;
                    s->render(rule);
                }
            CHECK(session.resolveRadiance() == first.rgba);
            CHECK(photons->tracedRays() == other.progress().rays.photon);
        }
}

TEST_CASE("photon pictures: glossy casters, equal for 1, 2 and 16 threads, bit by bit", "[photons]")
{
    for (const IntegratorKind kind : kKinds)
    {
        RenderOptions options = optionsOf(kind);
        options.photons = 7000;
        CAPTURE(int(kind));
        const Picture first = render(stage(0.3f).build(1), stageView(), options, 6, 1);
        for (const int threads : {2, 16})
        {
            const Picture again =
                render(stage(0.3f).build(threads), stageView(), options, 6, threads);
            const bool same = again.rgba == first.rgba;
            CHECK(same);
        }
        // Photons of the glossy box are part of the picture.
        const bool matters =
            render(stage(0.6f).build(1), stageView(), options, 6, 1).rgba != first.rgba;
        CHECK(matters);
    }
}

TEST_CASE("photon map: ten million photons in one cell", "[photons][stability 42][long]")
{
    constexpr uint32_t kMany = 10000000;
    const Workers workers(2);
    Photon photon;
    photon.position = Vec3(1, 2, 3);
    photon.normal = photon.wi = Vec3(0, 1, 0);
    photon.power = Vec3(1.0f, 0.5f, 0.25f);
    PhotonMap map;
    {
        std::vector<Photon> photons(kMany, photon);
        photons.push_back(photon);
        photons.back().position = Vec3(100.0f);
        map = PhotonMap(photons, 0.01f, workers);
    }
    PhotonQuery query;
    query.position = photon.position;
    query.normal = query.shadingNormal = photon.normal;
    query.radius = 0.01f;
    const PhotonSum sum = map.gather(query);
    CHECK(sum.count == kMany);
    CHECK(sum.power == Vec3(1e7f, 5e6f, 2.5e6f)); // sums by lane stay exact
    query.position = Vec3(100.0f);
    CHECK(map.gather(query).count == 1);
    query.position = Vec3(50.0f);
    CHECK(map.gather(query).count == 0);
    CHECK(map.bytes() < 50u * kMany);
}

TEST_CASE("photon pictures: a single photon, and all photons in one spot",
          "[photons][stability 42]")
{
    // The spot is so narrow that all photons of all passes land, by a mirror, within 1e-4 of each
    // other.
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), lambert(Vec3(0.7f)));
    builder.add(quadMesh({1, 1, -0.5f}, {0, -2, 0}, {0, 0, 2}), mirror(Vec3(1.0f)));
    Light laser = pointLight({0, 0, 1});
    laser.direction = glm::normalize(Vec3(1, 0, -0.5f));
    laser.spotCosCutoff = std::nextafter(1.0f, 0.0f);
    builder.addLight(laser);
    const auto laserScene = builder.build(), ordinary = stage().build();
    for (const IntegratorKind kind : kKinds)
        for (const RadiusSchedule schedule : {RadiusSchedule::Global, RadiusSchedule::Local})
            for (const int photons : {1, 2, 50000})
            {
                RenderOptions options = optionsOf(kind);
                options.radiusSchedule = schedule;
                options.photons = photons;
                CAPTURE(int(kind), int(schedule), photons);
                for (const auto& traced : {laserScene, ordinary})
                {
                    const Picture picture = render(traced, stageView(24), options, 3);
                    CHECK(picture.progress.status.ok());
                    CHECK(picture.progress.droppedSamples == 0);
                    CHECK(isFinite(picture.mean()));
                    CHECK(picture.progress.photonRadius > 0.0f);
                    if (photons > 2) CHECK(picture.progress.storedPhotons > 0);
                }
            }
}
