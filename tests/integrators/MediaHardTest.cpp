// MediaHardTest.cpp - media where numbers or places are extreme.
// SPDX-License-Identifier: MIT
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Adds walls that shine with radiance 1 at both ends of the x axis.
void addShiningWalls(SceneBuilder& builder, float distance)
{
    builder.add(quadMesh({distance, -9, -9}, {0, 0, 18}, {0, 18, 0}), lamp(Vec3(1.0f)));
    builder.add(quadMesh({-distance, -9, -9}, {0, 18, 0}, {0, 0, 18}), lamp(Vec3(1.0f)));
}

} // namespace

TEST_CASE("media: depths that no float holds are dark, and never invalid", "[integrators][media]")
{
    for (const float sigmaT : {1e6f, 1e30f, 3e38f})
        for (const float albedo : {0.0f, 0.5f})
            for (const bool around : {false, true})
                for (const IntegratorKind kind :
                     {IntegratorKind::Path, IntegratorKind::Whitted, IntegratorKind::Sppm})
                {
                    SceneBuilder builder;
                    const Medium medium = mediumOf(sigmaT, albedo);
                    if (around)
                        setAtmosphere(builder, medium, 90.0f);
                    else
                        builder.add(boxMesh({0, -3, -3}, {2, 3, 3}), bodyOf(medium));
                    addShiningWalls(builder, 5);
                    builder.addLight(pointLight({4, 0, 0}));
                    for (const double from : {-1.0, 1.0})
                    {
                        RenderOptions options = optionsOf(kind, 8);
                        options.photons = 1000;
                        const Picture picture = render(builder.build(), alongX(from), options, 2);
                        CAPTURE(sigmaT, albedo, around, int(kind), from);
                        CHECK(picture.progress.droppedSamples == 0);
                        CHECK(picture.mean().y >= 0.0f);
                        // From outside, what is scattered back is seen.
                        const bool lit = albedo > 0.0f && !around && from < 0.0;
                        CHECK(picture.mean().y < (lit ? 0.3f : 1e-3f));
                    }
                }
}

TEST_CASE("media: a camera on the face of a body looks from one side or the other",
          "[integrators][media]")
{
    SceneBuilder builder;
    builder.add(boxMesh({0, -3, -3}, {2, 3, 3}), bodyOf(mediumOf(0.5f, 0.0f)));
    addShiningWalls(builder, 5);
    const auto traced = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        CAPTURE(int(kind));
        const Vec3 through = render(traced, alongX(0.0, 1.0), optionsOf(kind), 1).mean();
        CHECK(through.y == Approx(std::exp(-1.0)).epsilon(1e-4));
        const Vec3 away = render(traced, alongX(0.0, -1.0), optionsOf(kind), 1).mean();
        CHECK(away.y == Approx(1.0).epsilon(1e-4));
    }
}

TEST_CASE("media: lights within bodies lose what is absorbed up to the surface",
          "[integrators][media]")
{
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        for (const float radius : {1.0f, 0.5f})
        {
            SceneBuilder builder;
            builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(1.0f)));
            builder.addLight(pointLight({0, 0, 2}));
            const View view = perspectiveView({0.5, 0, 0.5}, {0, 0, 0}, {0, 0, 1}, 1e-3, 4, 4);
            const Vec3 bare = render(builder.build(), view, optionsOf(kind, 1), 1).mean();
            builder.add(sphereMesh({0, 0, 2}, radius, 96), bodyOf(mediumOf(0.7f, 0.0f)));
            const Vec3 seen = render(builder.build(), view, optionsOf(kind, 1), 1).mean();
            CAPTURE(int(kind), radius, bare.y);
            CHECK(seen.y / bare.y == Approx(std::exp(-0.7 * double(radius))).epsilon(2e-3));
        }
}

TEST_CASE("media: the same bodies in other units, places and mirrors look the same",
          "[integrators][media]")
{
    const auto seen = [](const Affine& place, float sigmaT)
    {
        SceneBuilder builder;
        builder.add(boxMesh({0, -3, -3}, {2, 3, 3}), bodyOf(mediumOf(sigmaT, 0.0f)));
        Instance& body = builder.scene->instances.back();
        body.placed = true;
        body.engineFromLocal = place;
        body.mirrored = glm::determinant(place.linear) < 0.0f;
        const Vec3 from = transformPoint(place, {-4, 0.1f, 0.2f});
        const Vec3 to = transformPoint(place, {4, 0.1f, 0.2f});
        const float side = glm::length(to - from);
        const Vec3 up(0, 0, side), left(0, side, 0), corner = to - 0.5f * (up + left);
        const bool forwards = to.x > from.x;
        builder.add(quadMesh(corner, forwards ? up : left, forwards ? left : up), lamp(Vec3(1.0f)));
        const View view = perspectiveView(Vec3d(from), Vec3d(to), {0, 0, 1}, 1e-3, 4, 4);
        return render(builder.build(), view, optionsOf(IntegratorKind::Path), 1).mean().y;
    };
    const double expected = std::exp(-0.5 * 2.0);
    for (const float scale : {0.1f, 1.0f, 1e3f})
        for (const float sign : {1.0f, -1.0f})
        {
            Affine place;
            place.linear = Mat3(scale);
            place.linear[0][0] *= sign;
            CAPTURE(scale, sign);
            CHECK(seen(place, 0.5f / scale) == Approx(expected).epsilon(1e-4));
        }
    Affine far;
    far.translation = Vec3(1e4f, -2e4f, 500.0f);
    CHECK(seen(far, 0.5f) == Approx(expected).epsilon(2e-3)); // floats there are 0.001 apart
}

TEST_CASE("media: whatever goes nearly straight on keeps the light of a white sky",
          "[integrators][statistics][media]")
{
    for (const float g : {0.999f, -0.999f})
    {
        SceneBuilder builder;
        builder.add(sphereMesh(Vec3(0.0f), 1.0f, 24), bodyOf(mediumOf(3.0f, 1.0f, g)));
        addSky(builder);
        const Estimate seen = measure(builder.build(), patchView({0, 0, 4}, {0, 0, 1}, 1.0, 16),
                                      optionsOf(IntegratorKind::Path, 64), 4);
        CAPTURE(g, seen.mean(), seen.standardError());
        CHECK(seen.agrees(1.0, 1e-4));
    }
}
