// CameraTest.cpp - views of nothing, and eyes in unusual places. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"
#include "tests/stability/geometry/Compare.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

const IntegratorKind kBoth[] = {IntegratorKind::Whitted, IntegratorKind::Path};

/// Returns how many values are the first one. Every value of the picture must be one of the two.
int countOfTwo(const Picture& picture, float a, float b)
{
    int first = 0;
    for (int i = 0; i < picture.width * picture.height; ++i)
    {
        const float value = picture.at(i % picture.width, i / picture.width).y;
        REQUIRE((value == a || value == b));
        first += value == a;
    }
    return first;
}

/// Returns the unpolarised reflectance, from the side of index n to that of index 1.
double exactReflectance(double cosI, double n)
{
    const double sinT = n * std::sqrt(1.0 - cosI * cosI);
    if (sinT >= 1.0) return 1.0;
    const double cosT = std::sqrt(1.0 - sinT * sinT);
    const double s = (n * cosI - cosT) / (n * cosI + cosT);
    const double p = (cosI - n * cosT) / (cosI + n * cosT);
    return 0.5 * (s * s + p * p);
}

} // namespace

TEST_CASE("stability 21: without geometry nothing is covered, without lights all is black",
          "[stability]")
{
    const auto allEqual = [](const Picture& picture, Vec4 expected)
    {
        for (std::size_t i = 0; i < picture.rgba.size(); ++i)
            if (picture.rgba[i] != expected[static_cast<int>(i % 4)]) return false;
        return !picture.rgba.empty();
    };
    const View view = perspectiveView({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 20.0, 33, 17);
    // The radiance does not include the background, which is composited when the picture is
    // displayed.
    const Vec4 nothing(0.0f);
    for (const IntegratorKind kind : kBoth)
    {
        SceneBuilder empty;
        empty.scene->background = Vec4(0.25f, 0.5f, 0.75f, 1.0f);
        CHECK(allEqual(render(empty.build(), view, optionsOf(kind), 3), nothing));

        SceneBuilder lightOnly = empty;
        lightOnly.scene = std::make_shared<Scene>(*empty.scene);
        lightOnly.addLight(pointLight(Vec3(0, 0, 1)));
        CHECK(allEqual(render(lightOnly.build(), view, optionsOf(kind), 3), nothing));

        SceneBuilder dark = empty;
        dark.scene = std::make_shared<Scene>(*empty.scene);
        dark.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), lambert(Vec3(0.7f)));
        CHECK(allEqual(render(dark.build(), view, optionsOf(kind), 3), Vec4(0, 0, 0, 1)));
    }
}

TEST_CASE("stability 22: an eye exactly on a surface", "[stability]")
{
    // The scene has a black floor, a ceiling of radiance 1 and a cellar of radiance 7.
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), lambert(Vec3(0.0f)));
    builder.add(quadMesh({-1e4f, -1e4f, 5}, {0, 2e4f, 0}, {2e4f, 0, 0}), lamp(Vec3(1.0f)));
    builder.add(quadMesh({-1e4f, -1e4f, -5}, {2e4f, 0, 0}, {0, 2e4f, 0}), lamp(Vec3(7.0f)));
    const auto traced = builder.build();
    for (const IntegratorKind kind : kBoth)
    {
        // Rays of a perspective view begin at its near plane: above the floor they all meet the
        // ceiling, below it they all meet the cellar.
        for (const double side : {1.0, -1.0})
        {
            const Picture picture =
                render(traced,
                       perspectiveView({0.3, 0.2, 0.0}, Vec3d(0.8, 0.4, 2.0 * side), {0, 1, 0},
                                       60.0, 32, 32),
                       optionsOf(kind), 2);
            CHECK(picture.progress.droppedSamples == 0);
            CHECK(countOfTwo(picture, side > 0.0 ? 1.0f : 7.0f, -1.0f) == 32 * 32);
        }
        // Parallel rays begin on the floor itself, and meet the floor or what is behind it.
        View view;
        view.width = view.height = 32;
        view.viewFromWorld = glm::lookAt(Vec3d(0, 0, 2), Vec3d(0.0), Vec3d(0, 1, 0));
        view.clipFromView = glm::ortho(-1.0, 1.0, -1.0, 1.0, 2.0, 10.0);
        const Picture picture = render(traced, view, optionsOf(kind), 1);
        CHECK(picture.progress.droppedSamples == 0);
        countOfTwo(picture, 0.0f, 7.0f);
    }
}

TEST_CASE("stability 22: an eye inside of a light sees its radiance", "[stability]")
{
    SceneBuilder builder;
    builder.addEmissive(boxMesh(Vec3(-1.0f), Vec3(1.0f)), lamp(Vec3(3.0f)));
    const auto traced = builder.build();
    const View view = perspectiveView({0.1, 0.2, 0.3}, {0.5, -0.2, 0.1}, {0, 0, 1}, 100.0, 32, 32);
    for (const IntegratorKind kind : kBoth)
    {
        const Picture picture = render(traced, view, optionsOf(kind), 3);
        CHECK(countOfTwo(picture, 3.0f, -1.0f) == 32 * 32);
        CHECK(picture.progress.droppedSamples == 0);
    }
}

TEST_CASE("stability 22: an eye in glass in a white room sees n^2 times its radiance",
          "[stability][statistics]")
{
    // A black body's radiance is n^2 L in a medium. At a distance of half of the radius from a
    // ball's centre nothing is totally reflected: all reflected light leaves the ball in the end.
    SceneBuilder builder;
    builder.add(sphereMesh(Vec3(0.0f), 1.0f, 100), glass(1.5f));
    builder.add(boxMesh(Vec3(-9.0f), Vec3(9.0f)), lamp(Vec3(1.0f)));
    const View view = perspectiveView({0.3, 0.2, -0.3}, {0.5, -0.2, 0.1}, {0, 0, 1}, 100.0, 16, 16);
    const Estimate radiance =
        measure(builder.build(), view, optionsOf(IntegratorKind::Path, 64), 4);
    CAPTURE(radiance.mean(), radiance.standardError());
    CHECK(radiance.agrees(2.25, 1e-4));
}

TEST_CASE("stability 22: from inside of glass the world is in Snell's cone",
          "[stability][statistics]")
{
    // The eye is in a block with one interface at z = 0. Above it a lamp at height 2 covers x < 1,
    // and the rest is black. A ray at the angle theta sees T(theta) n^2 if it leaves the block and
    // meets the lamp, and nothing otherwise, as beyond the critical angle.
    constexpr double kDepth = 1.0, kHeight = 2.0, kEdge = 1.0, kIor = 1.5;
    SceneBuilder builder;
    builder.add(boxMesh({-50, -50, -50}, {50, 50, 0}), glass(1.5f));
    builder.add(quadMesh({-1e4f, -1e4f, kHeight}, {0, 2e4f, 0}, {1e4f + float(kEdge), 0, 0}),
                lamp(Vec3(1.0f)));
    const auto traced = builder.build();
    constexpr int kPixels = 48;
    const View view =
        perspectiveView({0, 0, -kDepth}, {0, 0, 0}, {0, 1, 0}, 110.0, kPixels, kPixels);
    const double extent = std::tan(glm::radians(55.0));
    std::vector<Estimate> pixels(kPixels * kPixels);
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        const Picture picture = render(traced, view, optionsOf(IntegratorKind::Path, 1, seed), 64);
        CHECK(picture.progress.droppedSamples == 0);
        for (int i = 0; i < kPixels * kPixels; ++i)
            pixels[static_cast<std::size_t>(i)].add(double(picture.at(i % kPixels, i / kPixels).y));
    }
    int litPixels = 0, wrong = 0;
    for (int y = 0; y < kPixels; ++y)
    {
        for (int x = 0; x < kPixels; ++x)
        {
            // These are the smallest and the largest value that the pixel's corners and a fine grid
            // in the pixel should see.
            double least = 1e9, most = 0.0;
            for (int sub = 0; sub < 64; ++sub)
            {
                const double u = (x + (sub % 8) / 7.0) / kPixels,
                             v = (y + (sub / 8) / 7.0) / kPixels;
                // The view goes along z with up = y, so that right is -x.
                const Vec3d d(-(2.0 * u - 1.0) * extent, (2.0 * v - 1.0) * extent, 1.0);
                const double sinI = std::hypot(d.x, d.y) / glm::length(d), sinT = kIor * sinI;
                double expected = 0.0;
                if (sinT < 1.0)
                {
                    const double tanT = sinT / std::sqrt(1.0 - sinT * sinT);
                    const double across = d.x / std::max(std::hypot(d.x, d.y), 1e-12);
                    const double meets = kDepth * d.x + kHeight * tanT * across;
                    if (meets < kEdge)
                        expected =
                            (1.0 - exactReflectance(1.0 / glm::length(d), kIor)) * kIor * kIor;
                }
                least = std::min(least, expected);
                most = std::max(most, expected);
            }
            const Estimate& pixel = pixels[static_cast<std::size_t>(y * kPixels + x)];
            const double margin = 4.0 * pixel.standardError() + 1e-3 * most;
            litPixels += least > 0.0;
            wrong += pixel.mean() < least - margin || pixel.mean() > most + margin;
        }
    }
    CAPTURE(litPixels);
    CHECK(litPixels > 200);
    // The bound is 4 sigma of 16 seeds in some 400 pixels, because dark ones have no noise: 0.4
    // pixels are wrong by chance, and more than 3 with a probability of 7e-4.
    CHECK(wrong <= 3);
}
