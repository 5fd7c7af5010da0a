// GroundTest.cpp - the ground shows the share of its light that something hides, and no more.
// SPDX-License-Identifier: MIT
#include "tests/Environments.h"
#include "tests/integrators/Measure.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr IntegratorKind kAll[] = {IntegratorKind::Whitted, IntegratorKind::Path};

/// Returns a square of side 1 around (0, 0, height), and a ground at z = 0.
SceneBuilder squareAbove(float height)
{
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -0.5f, height}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(0.5f)));
    builder.scene->ground = 0.0f;
    return builder;
}

/// Returns a view of a point of the ground, from the side and from below the square.
View viewOf(Vec3d point)
{
    return perspectiveView(point + Vec3d(0.0, -2.0, 0.4), point, {0, 0, 1}, 0.05, 8, 8);
}

float meanAlpha(const Picture& picture)
{
    double sum = 0.0;
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
        sum += double(picture.rgba[i]);
    return static_cast<float>(sum / (double(picture.width) * picture.height));
}

/// Returns the share of the diffuse light of a plane that a unit square hides which is parallel,
/// and right above at a height [Siegel's configuration factor of a parallel rectangle].
double hiddenBySquare(double height)
{
    const double x = 0.5 / height, root = std::sqrt(1.0 + x * x);
    return 4.0 / kPi * (x / root) * std::atan(x / root);
}

Light sunFrom(Vec3 direction)
{
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(-direction);
    sun.diffuse = Vec3(1.0f);
    return sun;
}

} // namespace

TEST_CASE("ground: a sun's shadow covers what is behind, and its light covers nothing",
          "[integrators][ground]")
{
    SceneBuilder builder = squareAbove(1.0f);
    builder.addLight(sunFrom(Vec3(1, 0, 1)));
    const auto scene = builder.build();
    for (const IntegratorKind kind : kAll)
    {
        CAPTURE(int(kind));
        const Picture dark = render(scene, viewOf({-1, 0, 0}), optionsOf(kind), 2);
        CHECK(meanAlpha(dark) == 1.0f);
        CHECK(dark.mean() == Vec3(0.0f));
        const Picture bright = render(scene, viewOf({0, 0, 0}), optionsOf(kind), 2);
        CHECK(meanAlpha(bright) == 0.0f);
        CHECK(bright.mean() == Vec3(0.0f));
        // The edge of the shadow is at x = -0.5.
        const View edge = perspectiveView({-0.5, 0, 0.5}, {-0.5, 0, 0}, {0, 1, 0}, 1.0, 8, 8);
        CHECK(meanAlpha(render(scene, edge, optionsOf(kind), 16)) == Approx(0.5).margin(0.02));
        RenderOptions unshadowed = optionsOf(kind);
        unshadowed.shadows = false;
        CHECK(meanAlpha(render(scene, viewOf({-1, 0, 0}), unshadowed, 2)) == 0.0f);
    }
}

TEST_CASE("ground: lights without shadows brighten the shadows of others", "[integrators][ground]")
{
    SceneBuilder builder = squareAbove(1.0f);
    builder.addLight(sunFrom(Vec3(1, 0, 1)));
    Light headlight = sunFrom(Vec3(1, 0, 1)); // behind the square, too
    headlight.castsShadows = false;
    headlight.diffuse = Vec3(3.0f);
    builder.addLight(headlight);
    for (const IntegratorKind kind : kAll)
    {
        const Picture dim = render(builder.build(), viewOf({-1, 0, 0}), optionsOf(kind), 2);
        CAPTURE(int(kind));
        CHECK(meanAlpha(dim) == Approx(0.25).epsilon(1e-5));
    }
}

TEST_CASE("ground: below a square an even sky leaves the closed form",
          "[integrators][statistics][ground]")
{
    for (const float height : {0.3f, 1.0f})
    {
        SceneBuilder builder = squareAbove(height);
        builder.addLight(environmentLight(newEnvironment(16, 8, [](Vec3d) { return Vec3(1.0f); })));
        const auto scene = builder.build();
        for (const IntegratorKind kind : kAll)
        {
            const Estimate seen = measure(scene, viewOf({0, 0, 0}), optionsOf(kind), 16);
            CAPTURE(int(kind), height, 1.0 - hiddenBySquare(double(height)), seen.mean(),
                    seen.standardError());
            CHECK(seen.agrees(1.0 - hiddenBySquare(double(height)), 2e-3));
        }
    }
}

namespace
{

/// Returns the irradiance of the origin of the plane z = 0 by a white sheet that a path sees there.
Estimate light(SceneBuilder builder)
{
    builder.scene = std::make_shared<Scene>(*builder.scene);
    builder.add(quadMesh({-0.1f, -0.1f, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}), lambert(Vec3(1.0f)));
    return measure(builder.build(), viewOf({0, 0, 0}), optionsOf(IntegratorKind::Path, 1), 64);
}

/// Adds one large lamp, or a row of small ones along y, which are left to a tree.
void addLamps(SceneBuilder& builder, int count)
{
    const float left = count == 1 ? -0.5f : 0.2f, side = count == 1 ? 1.5f : 0.2f;
    for (int k = 0; k < count; ++k)
    {
        const float y = 0.3f * (static_cast<float>(k) - 0.5f * static_cast<float>(count - 1));
        builder.addQuadLight({left, y, 2}, {0, side, 0}, {side, 0, 0}, Vec3(1.0f));
    }
}

} // namespace

TEST_CASE("ground: what lamps leave is the light of a white sheet over that without anything above",
          "[integrators][statistics][ground][long]")
{
    for (const int count : {1, 40})
    {
        SceneBuilder with, without;
        with.add(quadMesh({0.075f, -0.5f, 0.5f}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(0.0f)));
        addLamps(with, count);
        addLamps(without, count);
        const Estimate lit = light(with), all = light(without);
        const double expected = lit.mean() / all.mean();
        REQUIRE(expected > 0.1);
        REQUIRE(expected < 0.9);
        with.scene->ground = 0.0f;
        const auto scene = with.build();
        for (const IntegratorKind kind : kAll)
        {
            Estimate share;
            for (uint32_t seed = 0; seed < 16; ++seed)
                share.add(1.0 - double(meanAlpha(render(scene, viewOf({0, 0, 0}),
                                                        optionsOf(kind, 8, seed), 16))));
            CAPTURE(count, int(kind), expected, share.mean(), share.standardError());
            CHECK(share.agrees(expected, 5e-3));
        }
    }
}

TEST_CASE("ground: mirrors show its shadows, and it changes nothing of what stands on it",
          "[integrators][ground]")
{
    SceneBuilder builder = squareAbove(1.0f);
    builder.addLight(sunFrom(Vec3(1, 0, 1)));
    builder.scene->background = Vec4(1.0f);
    // A mirror that looks down from beyond the shadow: the view is that of its image.
    builder.add(quadMesh({-3, 2, 0}, {4, 0, 0}, {0, 0, 2}), mirror(Vec3(1.0f)));
    const View reflected = perspectiveView({-1, 0, 0.4}, {-1, 2, 0.2}, {0, 0, 1}, 0.05, 8, 8);
    const View square = perspectiveView({0, -3, 3}, {0, 0, 1}, {0, 0, 1}, 2.0, 8, 8);
    SceneBuilder bare = builder;
    bare.scene = std::make_shared<Scene>(*builder.scene);
    bare.scene->ground = kNoGround;
    for (const IntegratorKind kind : kAll)
    {
        CAPTURE(int(kind));
        const Picture seen = render(builder.build(), reflected, optionsOf(kind), 2);
        const Picture open = render(bare.build(), reflected, optionsOf(kind), 2);
        CHECK(open.mean() == Vec3(1.0f));
        CHECK(seen.mean() == Vec3(0.0f));
        CHECK(render(builder.build(), square, optionsOf(kind), 4).rgba ==
              render(bare.build(), square, optionsOf(kind), 4).rgba);
    }
}
