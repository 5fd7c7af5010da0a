// PhotonExtremesTest.cpp - photons in scenes that have too much or too little of something.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/photons/PhotonEmitter.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr IntegratorKind kPhotonKinds[] = {IntegratorKind::Ppm, IntegratorKind::Sppm,
                                           IntegratorKind::PhotonCaustics};
const Vec3 kBallCentre(-0.1f, 0.1f, 0.55f);
const Material kGrey = lambert(Vec3(0.7f));

SceneBuilder darkRoom()
{
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), kGrey);
    builder.add(quadMesh({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), lambert(Vec3(0.6f, 0.3f, 0.3f)));
    builder.add(sphereMesh(kBallCentre, 0.4f, 16), glass(1.5f));
    return builder;
}

SceneBuilder litRoom()
{
    SceneBuilder builder = darkRoom();
    builder.addQuadLight({-0.8f, -0.8f, 2.0f}, {0, 1.6f, 0}, {1.6f, 0, 0}, Vec3(2.0f));
    return builder;
}

View roomView()
{
    return perspectiveView({0.5, -3, 1.6}, {0, 0.1, 0.45}, {0, 0, 1}, 38.0, 24, 24);
}

RenderOptions photonOptions(IntegratorKind kind, int photons = 2000)
{
    RenderOptions options = optionsOf(kind);
    options.photons = photons;
    return options;
}

} // namespace

TEST_CASE("stability 39: any radius gives a finite picture, those out of bounds a note",
          "[photons][stability 39]")
{
    // The spacing of floats at the scene's coordinates is 2.4e-7.
    const struct
    {
        float radius;
        bool limited;
    } rows[] = {{0.0f, false},  {1e-38f, true}, {1e-12f, true}, {2.4e-7f, true},
                {1e-5f, false}, {0.1f, false},  {10.0f, true},  {1e30f, true}};
    const auto traced = litRoom().build();
    for (const IntegratorKind kind : kPhotonKinds)
        for (const RadiusSchedule schedule : {RadiusSchedule::Global, RadiusSchedule::Local})
            for (const auto& row : rows)
            {
                RenderOptions options = photonOptions(kind);
                options.photonRadius = row.radius;
                options.radiusSchedule = schedule;
                const Picture picture = render(traced, roomView(), options, 3);
                CAPTURE(int(kind), int(schedule), row.radius);
                CHECK(isFinite(picture.mean()));
                CHECK(picture.mean().y > 0.02f);
                CHECK(picture.progress.droppedSamples == 0);
                CHECK(picture.progress.photonRadius > 0.0f);
                CHECK(picture.progress.photonRadius < 10.0f); // clamped to the scene
                CHECK((picture.progress.photonNote == PhotonNote::RadiusLimited) == row.limited);
            }
}

TEST_CASE("stability 42: no photon and one photon a pass", "[photons][stability 42]")
{
    const auto traced = litRoom().build();
    for (const IntegratorKind kind : kPhotonKinds)
    {
        CAPTURE(int(kind));
        const Picture none = render(traced, roomView(), photonOptions(kind, 0), 3);
        CHECK(none.progress.rays.photon == 0);
        CHECK(none.progress.photonNote == PhotonNote::None); // no photons were asked for
        CHECK(none.mean().y > 0.02f);
        const Picture one = render(traced, roomView(), photonOptions(kind, 1), 20);
        CHECK(one.progress.rays.photon <= 20u * 8u);
        CHECK(one.progress.rays.photon > 0);
        CHECK(isFinite(one.mean()));
        CHECK(one.progress.droppedSamples == 0);
    }
}

TEST_CASE("photon extremes: a closed box of mirrors comes to an end, with a note", "[photons]")
{
    const auto box = []
    {
        SceneBuilder builder;
        builder.add(boxMesh(Vec3(-4.0f), Vec3(4.0f)), mirror(Vec3(1.0f)));
        builder.addLight(pointLight({1, 1, 1}));
        return builder;
    };
    const auto empty = box().build();
    SceneBuilder builder = box();
    builder.add(sphereMesh({-2, 0, 0}, 0.5f, 8), kGrey);
    const auto withBall = builder.build();
    for (const IntegratorKind kind : kPhotonKinds)
    {
        CAPTURE(int(kind));
        RenderOptions options = optionsOf(kind, 200);
        options.photons = 2000;
        const Picture picture = render(empty, roomView(), options, 2);
        CHECK(picture.progress.photonNote == PhotonNote::NoneStored);
        CHECK(picture.progress.storedPhotons == 0);
        CHECK(picture.progress.droppedSamples == 0);
        CHECK(picture.mean() == Vec3(0.0f));
        // Each photon takes all its edges, and no more.
        CHECK(picture.progress.rays.photon > 100u * 2u * 2000u);
        CHECK(picture.progress.rays.photon <= 200u * 2u * 2000u);

        const Picture lit = render(withBall, roomView(), options, 2);
        CHECK(lit.progress.photonNote == PhotonNote::None);
        CHECK(lit.progress.storedPhotons > 1000);
        CHECK(isFinite(lit.mean()));
    }
}

// There are 3 comparisons at 4 standard errors of 12 values each: a false alarm of all has a
// probability of 0.005.
TEST_CASE("photon extremes: a light inside of glass", "[photons][statistics][long]")
{
    SceneBuilder builder = darkRoom();
    builder.addEmissive(sphereMesh(kBallCentre, 0.15f, 12), lamp(Vec3(3.0f)));
    const auto traced = builder.build();
    const auto meanOf = [&](IntegratorKind kind, int passes)
    {
        Estimate estimate;
        for (uint32_t seed = 0; seed < 12; ++seed)
        {
            RenderOptions options = photonOptions(kind, 6000);
            options.photonRadius = 0.03f;
            options.maxBounces = 24;
            options.seed = 100 * seed + static_cast<uint32_t>(kind);
            const Picture picture = render(traced, roomView(), options, passes);
            REQUIRE(picture.progress.droppedSamples == 0);
            estimate.add(double(luminance(picture.mean())));
        }
        return estimate;
    };
    const Estimate path = meanOf(IntegratorKind::Path, 96);
    CHECK(path.mean() > 0.05);
    CHECK(path.standardError() < 0.01 * path.mean());
    for (const IntegratorKind kind : kPhotonKinds)
    {
        const Estimate photons = meanOf(kind, 16);
        const double spread = std::hypot(path.standardError(), photons.standardError());
        CAPTURE(int(kind), path.mean(), photons.mean(), spread);
        CHECK(std::abs(path.mean() - photons.mean()) <= 4.0 * spread);
    }
}

TEST_CASE("photon extremes: no path finds a point light inside of glass, photons do", "[photons]")
{
    SceneBuilder point = darkRoom();
    point.addLight(pointLight(kBallCentre + Vec3(0.1f, 0.0f, 0.05f)));
    const auto pointScene = point.build();
    for (const IntegratorKind kind : kPhotonKinds)
    {
        const Picture picture = render(pointScene, roomView(), photonOptions(kind), 4);
        CHECK(isFinite(picture.mean()));
        CHECK(picture.mean().y > 0.05f);
        CHECK(picture.progress.droppedSamples == 0);
    }
}

TEST_CASE("photon extremes: a million lights of no power", "[photons][long]")
{
    SceneBuilder builder = darkRoom();
    Light black = pointLight({0, 0, 1}, Vec3(0.0f));
    builder.scene->lights.assign(500000, black);
    black.kind = LightKind::Directional;
    builder.scene->lights.insert(builder.scene->lights.end(), 300000, black);
    Light area;
    area.kind = LightKind::Parallelogram;
    area.corner = {0, 0, 1};
    builder.scene->lights.insert(builder.scene->lights.end(), 200000, area);
    const auto traced = builder.build();
    CHECK(traced->lights().deltaLights().empty());
    CHECK(traced->lights().areaLights().empty());
    for (const IntegratorKind kind : kPhotonKinds)
    {
        const Picture picture = render(traced, roomView(), photonOptions(kind), 2);
        CAPTURE(int(kind));
        CHECK(picture.progress.photonNote == PhotonNote::NoPower);
        CHECK(picture.progress.rays.photon == 0);
        CHECK(picture.progress.rays.shadow == 0);
        CHECK(picture.mean() == Vec3(0.0f));
    }

    // If one light has power, it gets all photons, and the picture costs no more than with this
    // light alone.
    builder.addQuadLight({-0.8f, -0.8f, 2.0f}, {0, 1.6f, 0}, {1.6f, 0, 0}, Vec3(2.0f));
    const Picture many = render(builder.build(), roomView(), photonOptions(kPhotonKinds[1]), 2);
    const Picture alone = render(litRoom().build(), roomView(), photonOptions(kPhotonKinds[1]), 2);
    CHECK(many.progress.photonNote == PhotonNote::None);
    CHECK(many.progress.rays.total() == alone.progress.rays.total());
    CHECK(many.rgba == alone.rgba);
}
