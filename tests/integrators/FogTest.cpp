// FogTest.cpp - fog changes what the eye sees by the distance of it, in all integrators alike.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ToneMap.h"
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr IntegratorKind kAll[] = {IntegratorKind::Whitted, IntegratorKind::Path,
                                   IntegratorKind::Sppm, IntegratorKind::Ppm,
                                   IntegratorKind::PhotonCaustics};
const Vec3 kRadiance(0.9f, 0.4f, 2.0f);

Fog fogOf(FogMode mode)
{
    Fog fog;
    fog.mode = mode;
    fog.color = Vec3(0.5f, 0.6f, 0.7f);
    fog.density = 0.07f;
    fog.start = 2.0f;
    fog.end = 12.0f;
    return fog;
}

Material fogged(Material material, const Fog& fog)
{
    material.fog = fog;
    return material;
}

void checkColor(Vec3 color, Vec3 expected, double tolerance = 2e-5)
{
    for (int c = 0; c < 3; ++c)
        CHECK(color[c] == Approx(expected[c]).epsilon(tolerance));
}

/// Returns the view from (0, 0, 7) along -z.
View viewDown(int pixels = 8)
{
    return perspectiveView({0, 0, 7}, {0, 0, 0}, {0, 1, 0}, 60.0, pixels, pixels);
}

RenderOptions fewPhotons(IntegratorKind kind, int maxBounces = 8)
{
    RenderOptions options = optionsOf(kind, maxBounces);
    options.photons = 2000;
    return options;
}

Vec3 mixed(Vec3 color, const Fog& fog, double share)
{
    return color * static_cast<float>(share) + fog.color * static_cast<float>(1.0 - share);
}

} // namespace

TEST_CASE("fog: what a surface keeps is OpenGL's function of its depth", "[integrators]")
{
    const std::pair<FogMode, double> shares[] = {
        {FogMode::None, 1.0},
        {FogMode::Linear, (12.0 - 7.0) / (12.0 - 2.0)},
        {FogMode::Exponential, std::exp(-0.07 * 7.0)},
        {FogMode::ExponentialSquared, std::exp(-0.07 * 7.0 * 0.07 * 7.0)}};
    for (const auto& [mode, share] : shares)
        for (const IntegratorKind kind : kAll)
            for (const double unit : {1.0, 250.0})
            {
                CAPTURE(int(mode), int(kind), unit);
                SceneBuilder builder;
                const auto side = static_cast<float>(18.0 / unit);
                builder.add(quadMesh({-side / 2, -side / 2, 0}, {side, 0, 0}, {0, side, 0}),
                            fogged(lamp(kRadiance), fogOf(mode)));
                builder.scene->unit = unit;
                const Picture picture = render(builder.build(), viewDown(), fewPhotons(kind), 2);
                const Vec3 expected = mixed(kRadiance, fogOf(mode), share);
                for (int y = 0; y < 8; ++y) // all of the plane is at the same depth
                    for (int x = 0; x < 8; ++x)
                        checkColor(picture.at(x, y), expected);
            }
}

TEST_CASE("fog: linear fog ends, and a range of nothing is one of 1", "[integrators]")
{
    Fog fog = fogOf(FogMode::Linear);
    CHECK(fogShare(fog, 1.0f) == 1.0f);
    CHECK(fogShare(fog, 13.0f) == 0.0f);
    CHECK(fogShare(fog, -7.0f) == Approx(0.5f));
    fog.start = fog.end = 5.0f;
    CHECK(fogShare(fog, 4.75f) == Approx(0.25f));
    CHECK(fogShare(fog, 6.0f) == 0.0f);
}

TEST_CASE("fog: radial fog is by the distance from the eye", "[integrators]")
{
    Fog fog = fogOf(FogMode::Exponential);
    fog.radial = true;
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), fogged(lamp(kRadiance), fog));
    const double half = 7.0 * std::tan(glm::radians(30.0));
    const int pixels = 64;
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        const Picture picture = render(builder.build(), viewDown(pixels), optionsOf(kind), 16);
        for (const int x : {0, 20, 63})
        {
            const double px = ((x + 0.5) / pixels * 2.0 - 1.0) * half;
            const double py = (0.5 / pixels * 2.0 - 1.0) * half;
            const double share = std::exp(-0.07 * std::sqrt(px * px + py * py + 49.0));
            checkColor(picture.at(x, 0), mixed(kRadiance, fog, share), 2e-3);
        }
    }
}

TEST_CASE("fog: in a mirror things are as far as the way over it", "[integrators]")
{
    const Fog fog = fogOf(FogMode::Linear);
    SceneBuilder builder;
    builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}),
                fogged(mirror(Vec3(1.0f)), fog)); // 7 below the eye
    builder.add(quadMesh({-90, -90, 9}, {0, 180, 0}, {180, 0, 0}),
                fogged(lamp(kRadiance), fog)); // above the eye, seen in the mirror alone
    // Depth 7, and 9 more: but for the slant of the rays, f is (12 - 16) / 10 < 0.
    const View view = perspectiveView({0, 0, 7}, {0, 0, 0}, {0, 1, 0}, 0.5, 4, 4);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        checkColor(render(builder.build(), view, optionsOf(kind), 1).mean(), fog.color);
        SceneBuilder nearer;
        nearer.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), fogged(mirror(Vec3(1.0f)), fog));
        nearer.add(quadMesh({-90, 3, 2}, {0, 90, 0}, {180, 0, 0}), lambert(Vec3(0.0f)));
        nearer.add(quadMesh({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}), fogged(lamp(kRadiance), fog));
        // The lamp between the eye and the mirror is seen from behind, as deep as 5.
        checkColor(render(nearer.build(), view, optionsOf(kind), 1).mean(),
                   mixed(kRadiance, fog, 0.7));
        // A mirror without fog shows the fog of the whole way all the same.
        SceneBuilder clear;
        clear.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), mirror(Vec3(1.0f)));
        clear.add(quadMesh({-90, -90, 9}, {0, 180, 0}, {180, 0, 0}),
                  fogged(lamp(kRadiance), fogOf(FogMode::Exponential)));
        checkColor(render(clear.build(), view, optionsOf(kind), 1).mean(),
                   mixed(kRadiance, fog, std::exp(-0.07 * 9.0)), 1e-3);
    }
}

TEST_CASE("fog: blended layers have it each by its own depth", "[integrators]")
{
    const Fog fog = fogOf(FogMode::Exponential);
    Material layer = fogged(lamp(Vec3(0.2f, 0.9f, 0.1f)), fog);
    layer.alpha = 0.25f;
    layer.blended = true;
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), fogged(lamp(kRadiance), fog));
    builder.add(quadMesh({-9, -9, 4}, {18, 0, 0}, {0, 18, 0}), layer);
    const Vec3 expected = mixed(layer.emission, fog, std::exp(-0.07 * 3.0)) * 0.25f +
                          mixed(kRadiance, fog, std::exp(-0.07 * 7.0)) * 0.75f;
    checkColor(render(builder.build(), viewDown(), optionsOf(IntegratorKind::Whitted), 1).mean(),
               expected);
    const Estimate path =
        measure(builder.build(), viewDown(16), optionsOf(IntegratorKind::Path), 64);
    CHECK(std::abs(path.mean() - double(expected.y)) < 4.0 * path.standardError());
    CHECK(path.standardError() < 0.01);
}

TEST_CASE("fog: a picture of one depth is the clear one mixed with the colour of the fog",
          "[integrators]")
{
    // Without roulette, which looks at the throughput, all paths are the same ones.
    const Fog fog = fogOf(FogMode::ExponentialSquared);
    const float share = fogShare(fog, 7.0f);
    for (const IntegratorKind kind : kAll)
    {
        CAPTURE(int(kind));
        Vec3 means[2];
        for (const bool foggy : {false, true})
        {
            SceneBuilder builder;
            Material floor = lambert(Vec3(0.7f, 0.5f, 0.3f));
            if (foggy) floor.fog = fog;
            builder.add(quadMesh({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), floor);
            builder.add(quadMesh({-4, -4, 8}, {0, 8, 0}, {8, 0, 0}), lambert(Vec3(0.8f)));
            builder.addQuadLight({-3, 3.9f, 1}, {6, 0, 0}, {0, 0, 3}, Vec3(4.0f), true);
            builder.addLight(pointLight({2, 1, 4}, Vec3(3.0f)));
            means[foggy] = render(builder.build(),
                                  perspectiveView({0, 0, 7}, {0, 0, 0}, {0, 1, 0}, 20.0, 32, 32),
                                  fewPhotons(kind, 2), 4)
                               .mean();
        }
        CHECK(means[0].x > 0.1f);
        checkColor(means[1], mixed(means[0], fog, double(share)), 1e-4);
    }
}

TEST_CASE("fog: what guides the filters shows the fog, too", "[integrators]")
{
    const Fog fog = fogOf(FogMode::Exponential);
    for (const bool displayReferred : {false, true})
    {
        SceneBuilder builder;
        builder.scene->displayReferred = displayReferred;
        builder.add(quadMesh({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}),
                    fogged(lambert(Vec3(0.25f, 0.5f, 1.0f)), fog));
        RenderSession session(std::make_shared<Workers>(1));
        RenderOptions options = optionsOf(IntegratorKind::Path);
        options.centredFirstPass = true;
        session.setScene(builder.build());
        session.setView(viewDown());
        session.setOptions(options);
        StopRule rule;
        rule.passes = 1;
        REQUIRE(session.render(rule).status.ok());
        const Vec3 expected = mixed(Vec3(0.25f, 0.5f, 1.0f), fog, std::exp(-0.07 * 7.0));
        const Vec3 albedo = session.surfaceSamples().at(11).albedo;
        for (int c = 0; c < 3; ++c) // decoded within 0.002
            CHECK(albedo[c] ==
                  Approx(displayReferred ? linearFromSrgb(expected[c]) : expected[c]).margin(2e-3));
    }
}

TEST_CASE("fog: light that pixels share is behind each pixel's own fog",
          "[integrators][statistics]")
{
    const auto inFog = [](bool reused)
    {
        SceneBuilder box = cornellBox();
        for (Material& material : box.scene->materials)
        {
            if (material.emission != Vec3(0.0f)) continue;
            if (!reused)
            {
                Material varying; // of a colour that could differ from point to point
                varying.diffuse = material.baseColor;
                varying.vertexColorUse = VertexColorUse::Ambient;
                material = varying;
            }
            material.fog = fogOf(FogMode::Exponential);
            material.fog.density = 1e-3f;
        }
        const View view = perspectiveView({278, 200, -800}, {278, 120, 279}, {0, 1, 0}, 15, 16, 16);
        return measure(box.build(), view, optionsOf(IntegratorKind::Path, 4), 64);
    };
    const Estimate own = inFog(false), reused = inFog(true);
    const double error = std::hypot(own.standardError(), reused.standardError());
    CAPTURE(own.mean(), reused.mean(), error);
    CHECK(std::abs(own.mean() - reused.mean()) < 4.0 * error); // fails 1 time in 16,000
    CHECK(error < 0.02 * own.mean());
}
