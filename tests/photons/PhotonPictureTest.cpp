// PhotonPictureTest.cpp - pictures made with photons have the light that path tracing and formulas
// give.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/integrators/shared/HitPoints.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 24;

/// Returns a floor and a wall under a light so large that path tracing finds it through glass and
/// mirrors.
SceneBuilder room(const Material& floor, const Material& wall = lambert(Vec3(0.6f, 0.3f, 0.3f)))
{
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), floor);
    builder.add(quadMesh({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), wall);
    builder.addQuadLight({-0.8f, -0.8f, 2.0f}, {0, 1.6f, 0}, {1.6f, 0, 0}, Vec3(2.0f));
    return builder;
}

View roomView()
{
    return perspectiveView({0.5, -3, 1.6}, {0, 0.1, 0.45}, {0, 0, 1}, 38.0, kSize, kSize);
}

RenderOptions photonOptions(IntegratorKind kind)
{
    RenderOptions options = optionsOf(kind, 24);
    options.photons = 6000;
    options.photonRadius = 0.02f; // a hundredth of the room: losses at edges are below the noise
    return options;
}

/// Returns the mean over the image, with one value for each of 12 seeds.
Estimate meanOf(const std::shared_ptr<const TracedScene>& traced, const View& view,
                RenderOptions options, int passes)
{
    Estimate estimate;
    for (uint32_t seed = 0; seed < 12; ++seed)
    {
        options.seed = 100 * seed + static_cast<uint32_t>(options.integrator);
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        REQUIRE(picture.progress.integrator == options.integrator);
        estimate.add(double(luminance(picture.mean())));
    }
    return estimate;
}

/// Checks that photons agree with paths, in passes of times 24 with photons and times 64 without.
void checkAgreement(const char* name, const SceneBuilder& builder, int times = 1)
{
    const auto traced = builder.build();
    const Estimate path =
        meanOf(traced, roomView(), photonOptions(IntegratorKind::Path), 64 * times);
    REQUIRE(path.mean() > 0.05);
    CHECK(path.standardError() < 0.008 * path.mean()); // shows a difference of 5 %
    for (const IntegratorKind kind :
         {IntegratorKind::Sppm, IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
    {
        const int sharing = kind == IntegratorKind::Ppm ? kPathPasses : 1; // gives as many paths
        const Estimate photons =
            meanOf(traced, roomView(), photonOptions(kind), 24 * times * sharing);
        const double spread = std::hypot(path.standardError(), photons.standardError());
        CAPTURE(name, int(kind), path.mean(), photons.mean(), spread);
        CHECK(photons.standardError() < 0.01 * path.mean());
        CHECK(std::abs(path.mean() - photons.mean()) <= 4.0 * spread);
    }
}

const Vec3 kBallCentre(-0.1f, 0.1f, 0.55f);
const Material kGrey = lambert(Vec3(0.7f));

} // namespace

// There are 18 comparisons at 4 standard errors of 12 values each: a false alarm of all has a
// probability of 0.02; the seeds are fixed.
TEST_CASE("photon pictures: a glass ball", "[photons][statistics]")
{
    SceneBuilder builder = room(kGrey);
    builder.add(sphereMesh(kBallCentre, 0.4f, 24), glass(1.5f));
    checkAgreement("glass", builder);
}

TEST_CASE("photon pictures: a mirror box", "[photons][statistics]")
{
    SceneBuilder builder = room(kGrey);
    builder.add(boxMesh({-0.5f, -0.3f, 0.05f}, {0.2f, 0.3f, 0.7f}), mirror(Vec3(0.9f, 0.8f, 0.7f)));
    checkAgreement("mirror", builder);
}

TEST_CASE("photon pictures: a diffuse box", "[photons][statistics]")
{
    SceneBuilder builder = room(kGrey);
    builder.add(boxMesh({-0.5f, -0.3f, 0.05f}, {0.2f, 0.3f, 0.7f}),
                lambert(Vec3(0.3f, 0.6f, 0.3f)));
    checkAgreement("diffuse", builder);
}

TEST_CASE("photon pictures: rough glass", "[photons][statistics]")
{
    SceneBuilder builder = room(kGrey);
    builder.add(sphereMesh(kBallCentre, 0.4f, 24), glass(1.5f, 0.55f));
    // Photons are looked up on the glass itself, from both sides. When camera paths could not leave
    // the glass at angles beyond the critical one, as its facets let light do, photons gave 2 %
    // more light.
    checkAgreement("rough glass", builder);
}

TEST_CASE("photon pictures: diffuse surfaces under a mirror-like coat", "[photons][statistics]")
{
    Material coated = lambert(Vec3(0.6f, 0.5f, 0.4f));
    coated.ior = 1.5f;
    coated.roughness = 0.0f;
    SceneBuilder builder = room(coated);
    builder.add(sphereMesh(kBallCentre, 0.4f, 24), coated);
    checkAgreement("coat", builder);
}

// At the wall only direct photons are looked up; at the surfaces that it reflects all photons are.
TEST_CASE("photon pictures: a glossy wall", "[photons][statistics]")
{
    Material glossy = mirror(Vec3(0.9f));
    glossy.roughness = 0.35f;
    SceneBuilder builder = room(lambert(Vec3(0.9f)), glossy);
    builder.add(sphereMesh({-0.1f, 0.4f, 0.55f}, 0.5f, 24), glass(1.5f));
    checkAgreement("glossy", builder, 4);
}

// There are 12 comparisons at 4 standard errors of 12 values each: a false alarm of all has a
// probability of 0.02.
TEST_CASE("photon pictures: as many edges a path as path tracing has, from 1 on",
          "[photons][statistics]")
{
    // The scene has four surfaces that all matter: with one edge too many or too few the means
    // differ by 10 % and more.
    SceneBuilder builder = room(kGrey);
    builder.add(quadMesh({-1, 1, 0}, {0, -2, 0}, {0, 0, 2}), mirror(Vec3(0.9f)));
    builder.add(boxMesh({-0.1f, -0.3f, 0.05f}, {0.4f, 0.3f, 0.5f}), glass(1.5f));
    const auto traced = builder.build();
    double previous = 0.0;
    for (const int bounces : {1, 2, 3, 4})
    {
        RenderOptions options = photonOptions(IntegratorKind::Path);
        options.maxBounces = bounces;
        const Estimate path = meanOf(traced, roomView(), options, 64);
        CHECK(path.standardError() < 0.008 * path.mean());
        CHECK(path.mean() > 1.03 * previous); // each edge adds light
        previous = path.mean();
        for (const IntegratorKind kind :
             {IntegratorKind::Sppm, IntegratorKind::Ppm, IntegratorKind::PhotonCaustics})
        {
            options.integrator = kind;
            const Estimate photons = meanOf(traced, roomView(), options, 24);
            const double spread = std::hypot(path.standardError(), photons.standardError());
            CAPTURE(bounces, int(kind), path.mean(), photons.mean(), spread);
            CHECK(photons.standardError() < 0.01 * path.mean());
            CHECK(std::abs(path.mean() - photons.mean()) <= 4.0 * spread);
        }
    }
}

// The light of a point light by a flat mirror is, on the floor, that of the light's mirror image.
// Path tracing cannot find it.
TEST_CASE("photon pictures: a point light and its mirror image", "[photons][statistics]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), lambert(Vec3(0.5f)));
    builder.add(quadMesh({1, 3, 0}, {0, -6, 0}, {0, 0, 4}), mirror(Vec3(1.0f)));
    builder.addLight(pointLight({0, 0, 1}));
    const auto traced = builder.build();
    constexpr double kSide = 0.2;
    const Vec3d centre(-0.2, 0.3, 0.0);
    const auto irradiance = [&](Vec3d light)
    {
        double sum = 0.0;
        for (int k = 0; k < 64; ++k)
        {
            const Vec3d p =
                centre + Vec3d((k % 8 + 0.5) / 8 - 0.5, (k / 8 + 0.5) / 8 - 0.5, 0.0) * kSide;
            const Vec3d d = light - p;
            sum += glm::pi<double>() * d.z / std::pow(glm::dot(d, d), 1.5) / 64.0;
        }
        return sum;
    };
    const double direct = 0.5 / glm::pi<double>() * irradiance({0, 0, 1});
    const double mirrored = 0.5 / glm::pi<double>() * irradiance({2, 0, 1});
    const View view = patchView(centre, {0, 0, 1}, kSide, 16);

    // Paths have two edges after the camera ray: light does not go from floor to mirror to floor.
    RenderOptions options = optionsOf(IntegratorKind::Path, 2);
    options.photons = 10000;
    options.photonRadius = 0.1f;
    CHECK(meanOf(traced, view, options, 8).mean() == Approx(direct).epsilon(1e-3));
    for (const IntegratorKind kind :
         {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm, IntegratorKind::Ppm})
    {
        options.integrator = kind;
        const Estimate estimate = meanOf(traced, view, options, 48);
        CAPTURE(int(kind), estimate.mean() - direct, mirrored, estimate.standardError());
        CHECK(estimate.standardError() < 0.02 * mirrored);
        CHECK(estimate.agrees(direct + mirrored, 2e-3 * mirrored)); // the density is curved
    }
}

TEST_CASE("photon pictures: equal for 1 and 2 threads, bit by bit", "[photons]")
{
    SceneBuilder builder = room(kGrey);
    builder.add(sphereMesh(kBallCentre, 0.4f, 24), glass(1.5f));
    builder.addLight(pointLight({0.5f, -0.5f, 1.5f}, Vec3(0.2f)));
    const auto traced = builder.build();
    for (const IntegratorKind kind :
         {IntegratorKind::Ppm, IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
        for (const RadiusSchedule schedule : {RadiusSchedule::Global, RadiusSchedule::Local})
        {
            RenderOptions options = optionsOf(kind);
            options.photons = 5000;
            options.radiusSchedule = schedule;
            const Picture one = render(traced, roomView(), options, 5, 1);
            const Picture two = render(traced, roomView(), options, 5, 2);
            CAPTURE(int(kind), int(schedule));
            CHECK(one.rgba == two.rgba);
            CHECK(one.progress.rays.photon == two.progress.rays.photon);
            CHECK(one.progress.storedPhotons > 0);
        }
}

TEST_CASE("photon pictures: local and global radii agree in the mean", "[photons][statistics]")
{
    SceneBuilder builder = room(kGrey);
    builder.add(boxMesh({-0.5f, -0.3f, 0.05f}, {0.2f, 0.3f, 0.7f}),
                lambert(Vec3(0.3f, 0.6f, 0.3f)));
    const auto traced = builder.build();
    RenderOptions options = photonOptions(IntegratorKind::Sppm);
    const Estimate global = meanOf(traced, roomView(), options, 48);
    options.radiusSchedule = RadiusSchedule::Local;
    const Estimate local = meanOf(traced, roomView(), options, 48);
    const double spread = std::hypot(local.standardError(), global.standardError());
    CAPTURE(local.mean(), global.mean(), spread);
    CHECK(local.standardError() > 0.0);
    CHECK(std::abs(local.mean() - global.mean()) <= 4.0 * spread);
}

TEST_CASE("photon pictures: nothing to emit, nothing to meet, nothing to see", "[photons]")
{
    SceneBuilder dark;
    dark.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.5f)));
    dark.add(sphereMesh(kBallCentre, 0.4f, 8), glass(1.5f));
    SceneBuilder lit = room(kGrey);
    lit.add(sphereMesh(kBallCentre, 0.4f, 8), glass(1.5f));
    const auto empty = SceneBuilder().build(), darkScene = dark.build(), litScene = lit.build();
    for (const IntegratorKind kind :
         {IntegratorKind::Ppm, IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind);
        options.photons = 2000;
        CHECK(render(empty, roomView(), options, 2).mean() == Vec3(0.0f));
        CHECK(render(darkScene, roomView(), options, 2).mean() == Vec3(0.0f));
        options.photons = 0;
        const Picture none = render(litScene, roomView(), options, 2);
        CHECK(none.progress.storedPhotons == 0);
        CHECK(none.mean().y > 0.05f);
        options.photons = 1;
        CHECK(isFinite(render(litScene, roomView(), options, 3).mean()));
    }
    // Without photons all paths are the path tracer's.
    RenderOptions options = optionsOf(IntegratorKind::PhotonCaustics);
    options.photons = 0;
    CHECK(render(litScene, roomView(), options, 2).rgba ==
          render(litScene, roomView(), optionsOf(IntegratorKind::Path), 2).rgba);
    // Without mirror-like surfaces all paths are the path tracer's, too, and no photon is traced.
    const auto diffuse = room(kGrey).build();
    const Picture picture =
        render(diffuse, roomView(), optionsOf(IntegratorKind::PhotonCaustics), 2);
    CHECK(picture.progress.rays.photon == 0);
    CHECK(picture.rgba == render(diffuse, roomView(), optionsOf(IntegratorKind::Path), 2).rgba);
}
