// SsimTest.cpp - the structural similarity by hand, and that of pictures that move.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "apps/osgraytracebench/report/Ssim.h"
#include "osgRayTrace/film/Enlarge.h"
#include "osgRayTrace/session/upsample/Upsample.h"

using namespace osgRayTrace::bench;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 320, kHeight = 180;

std::vector<uint8_t> grey(int value, int noise, uint32_t seed)
{
    Uniform random(seed);
    std::vector<uint8_t> picture;
    for (int i = 0; i < 4 * 40 * 30; ++i)
        picture.push_back(static_cast<uint8_t>(float(value) + float(noise) * (random() - 0.5f)));
    return picture;
}

/// Returns a street with stripes, and boxes on it.
std::shared_ptr<const TracedScene> street()
{
    SceneBuilder builder;
    builder.add(quadMesh({-40, 0, 10}, {80, 0, 0}, {0, 0, -120}), lambert(Vec3(0.05f)));
    for (int i = 0; i < 30; ++i)
        for (int lane = 0; lane < 4; ++lane)
            builder.add(quadMesh({-6.0f + 4.0f * float(lane), 0.01f, 8.0f - 3.0f * float(i)},
                                 {0.2f, 0, 0}, {0, 0, -1.5f}),
                        lambert(Vec3(0.9f)));
    for (int i = 0; i < 8; ++i)
    {
        const float x = -5.5f + 4.0f * float(i % 3), z = 3.0f - 6.0f * float(i);
        const Vec3 paint(0.8f, 0.1f * float(i), 0.2f);
        builder.add(boxMesh({x, 0.3f, z - 4}, {x + 1.8f, 1.0f, z}), lambert(paint));
        builder.add(boxMesh({x + 0.1f, 1.0f, z - 3}, {x + 1.7f, 1.5f, z - 1}),
                    lambert(Vec3(0.02f)));
    }
    builder.scene->lights.push_back(pointLight({-20, 40, 20}, Vec3(1200.0f)));
    return builder.build();
}

struct Shown
{
    std::vector<uint8_t> rgba = std::vector<uint8_t>(4 * kWidth * kHeight);
    std::vector<float> depth = std::vector<float>(kWidth * kHeight);
};

void render(RenderSession& session, const std::shared_ptr<const TracedScene>& scene, int divider,
            int passes)
{
    RenderOptions options = optionsOf(IntegratorKind::Whitted);
    options.centredFirstPass = divider > 1;
    session.setScene(scene);
    session.setView(perspectiveView({0, 9, 16}, {0, 0, -12}, {0, 1, 0}, 40.0, kWidth / divider,
                                    kHeight / divider));
    session.setOptions(options);
    StopRule rule;
    rule.passes = passes;
    REQUIRE(session.render(rule).status.ok());
}

} // namespace

TEST_CASE("ssim: equal pictures have 1, flat ones that of their means, noise about 0", "[report]")
{
    const auto flat = grey(100, 0, 1), brighter = grey(150, 0, 1);
    CHECK(meanSsim(flat, flat, 40, 30) == 1.0);
    const double c1 = 0.01 * 255.0 * 0.01 * 255.0;
    const double expected = (2.0 * 100.0 * 150.0 + c1) / (100.0 * 100.0 + 150.0 * 150.0 + c1);
    CHECK(meanSsim(flat, brighter, 40, 30) == Approx(expected).epsilon(1e-9));
    const auto noise = grey(128, 200, 2), other = grey(128, 200, 3);
    CHECK(meanSsim(noise, noise, 40, 30) == Approx(1.0).epsilon(1e-9));
    CHECK(std::abs(meanSsim(noise, other, 40, 30)) < 0.1);
    CHECK(meanSsim(noise, other, 40, 30) == Approx(meanSsim(other, noise, 40, 30)));
}

TEST_CASE("ssim: light of an eighth of the size and first hits of the full one are legible",
          "[report]")
{
    const auto scene = street();
    RenderSession full(std::make_shared<Workers>(2)), small(std::make_shared<Workers>(2));
    render(full, scene, 1, 32);
    Shown converged;
    full.resolveDisplay({}, converged.rgba.data(), converged.depth.data());
    for (const int divider : {4, 8})
    {
        render(small, scene, divider, 1);
        const int width = small.width(), height = small.height();
        std::vector<uint8_t> rgba(4 * std::size_t(width * height));
        std::vector<float> depth(std::size_t(width * height));
        small.resolveDisplay({}, rgba.data(), depth.data());
        Shown enlarged, upsampled;
        enlarge({width, height, rgba.data(), depth.data()},
                {kWidth, kHeight, enlarged.rgba.data(), enlarged.depth.data()}, Workers(1));
        small.presentUpsampled(small.resolvedImage(), small.surfaceSamples(), kWidth, kHeight,
                               {{}, upsampled.rgba.data(), upsampled.depth.data()}, kAllTraced);
        const double plain = meanSsim(enlarged.rgba, converged.rgba, kWidth, kHeight),
                     legible = meanSsim(upsampled.rgba, converged.rgba, kWidth, kHeight);
        CAPTURE(divider, plain, legible);
        CHECK(legible > 0.9);
        CHECK(legible > plain + 0.05);
    }
}
