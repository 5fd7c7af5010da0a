// ResolvedImageTest.cpp - images that pass through the stages to the display equal those that do
// not.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include <algorithm>
#include <cstdlib>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 37, kHeight = 21;

/// Returns a lit plane that fills half of the view.
std::shared_ptr<const TracedScene> litPlane(bool displayReferred)
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {4, 0, 0}, {0, 8, 0}), lambert(Vec3(0.2f, 0.4f, 0.6f)));
    builder.scene->lights.push_back(pointLight({-1, 0, 3}, Vec3(9.0f)));
    builder.scene->displayReferred = displayReferred;
    return builder.build();
}

/// Traces one pass of the plane.
void traceLitPlane(RenderSession& session, bool displayReferred)
{
    session.setScene(litPlane(displayReferred));
    session.setView(perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, kWidth, kHeight));
    session.setOptions(optionsOf(IntegratorKind::Whitted));
    StopRule rule;
    rule.passes = 1;
    REQUIRE(session.render(rule).status.ok());
}

} // namespace

TEST_CASE("resolved image: display values and depths are those of resolveDisplay", "[session]")
{
    for (const bool displayReferred : {false, true})
    {
        RenderSession session(std::make_shared<Workers>(2));
        CHECK(session.resolvedImage().width == 0);
        CHECK(session.surfaceSamples().empty());
        session.setScene(litPlane(displayReferred));
        session.setView(perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, kWidth, kHeight));
        session.setOptions(optionsOf(IntegratorKind::Whitted));
        for (const int passes : {1, 3})
        {
            StopRule rule;
            rule.passes = passes;
            REQUIRE(session.render(rule).status.ok());
            const ResolvedImage image = session.resolvedImage();
            CHECK(image.error.size() == (passes < 2 ? 0u : 3u * kWidth * kHeight));
            for (const float exposure : {0.0f, -1.5f})
            {
                const ToneMap toneMap{exposure, displayReferred};
                std::vector<uint8_t> expected(4 * kWidth * kHeight), shown(4 * kWidth * kHeight);
                std::vector<float> expectedDepth(kWidth * kHeight), depth(kWidth * kHeight);
                session.resolveDisplay(toneMap, expected.data(), expectedDepth.data());
                presentImage(image, toneMap, Workers(2), shown.data(), depth.data());
                CHECK(depth == expectedDepth);
                int brightest = 0, largest = 0;
                for (std::size_t i = 0; i < shown.size(); ++i)
                {
                    if (i % 4 != 3) brightest = std::max(brightest, int(shown[i]));
                    largest = std::max(largest, std::abs(shown[i] - expected[i]));
                }
                CHECK(brightest > 40);
                CHECK(largest <=
                      (displayReferred ? 1 : 0)); // display values are decoded and encoded again
            }
        }
    }
}

TEST_CASE("resolved image: samples of surfaces are the channels of the first hit", "[session]")
{
    RenderSession session(std::make_shared<Workers>(2));
    traceLitPlane(session, false);
    const std::vector<SurfaceSample> samples = session.surfaceSamples();
    const std::vector<float> normal = session.resolveChannel(Channel::Normal);
    const std::vector<float> albedo = session.resolveChannel(Channel::Albedo);
    const std::vector<float> distance = session.resolveChannel(Channel::Distance);
    const std::vector<float> id = session.resolveChannel(Channel::Id);
    REQUIRE(samples.size() == kWidth * kHeight);
    int hits = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        hits += samples[i].object > 0;
        REQUIRE(samples[i].distance == distance[i]);
        REQUIRE(static_cast<float>(samples[i].object) == id[i]);
        for (int c = 0; c < 3; ++c)
        {
            REQUIRE(samples[i].normal[c] == normal[3 * i + static_cast<std::size_t>(c)]);
            REQUIRE(samples[i].albedo[c] == albedo[3 * i + static_cast<std::size_t>(c)]);
        }
    }
    CHECK(hits > 100);
    CHECK(hits < kWidth * kHeight - 100);
}

TEST_CASE("resolved image: surfaces' albedo is linear where the film is not", "[session]")
{
    RenderSession session(std::make_shared<Workers>(2));
    traceLitPlane(session, true);
    int hits = 0;
    for (const SurfaceSample& sample : session.surfaceSamples())
    {
        if (sample.object == 0) continue;
        ++hits;
        REQUIRE(std::abs(sample.albedo.x - linearFromSrgb(0.2f)) < 0.002f);
        REQUIRE(std::abs(sample.albedo.z - linearFromSrgb(0.6f)) < 0.002f);
    }
    CHECK(hits > 100);
}

TEST_CASE("resolved image: samples tell lamps and mirrors from what scatters light", "[session]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {4, 0, 0}, {0, 8, 0}), lambert(Vec3(0.5f)));
    builder.add(quadMesh({0, -4, 0}, {4, 0, 0}, {0, 4, 0}), mirror(Vec3(0.9f)));
    builder.addQuadLight({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, Vec3(2.0f));
    RenderSession session(std::make_shared<Workers>(2));
    session.setScene(builder.build());
    session.setView(perspectiveView({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 50.0, 8, 8));
    session.setOptions(optionsOf(IntegratorKind::Whitted));
    StopRule rule;
    rule.passes = 1;
    REQUIRE(session.render(rule).status.ok());
    const std::vector<SurfaceSample> samples = session.surfaceSamples();
    CHECK(samples[1 * 8 + 1].kind == SurfaceKind::Scattering);
    CHECK(samples[1 * 8 + 6].kind == SurfaceKind::Smooth);
    CHECK(samples[6 * 8 + 6].kind == SurfaceKind::Emitting);
}

TEST_CASE("resolved image: samples that a first pass through the middles records are those traced "
          "for them",
          "[session]")
{
    SceneBuilder builder = cornellBox();
    for (Material& material : builder.scene->materials)
        if (material.baseColor == Vec3(0.73f))
        {
            material.metallic = 1.0f;
            material.roughness = 0.4f;
        }
    builder.add(quadMesh({100, 300, 200}, {200, 0, 0}, {0, 200, 0}), mirror(Vec3(0.9f)));
    builder.addQuadLight({350, 300, 200}, {0, 100, 0}, {100, 0, 0}, Vec3(2.0f));
    for (const bool displayReferred : {false, true})
    {
        builder.scene->displayReferred = displayReferred;
        const auto scene = builder.build();
        for (const IntegratorKind kind :
             {IntegratorKind::Whitted, IntegratorKind::Path, IntegratorKind::Ppm})
        {
            RenderSession noting(std::make_shared<Workers>(2)),
                tracing(std::make_shared<Workers>(2));
            for (const int width : {3 * kWidth, kWidth})
            {
                CAPTURE(displayReferred, static_cast<int>(kind), width);
                const View view = perspectiveView({278, 273, -800}, {278, 273, 279}, {0, 1, 0},
                                                  40.0, width, kHeight);
                RenderOptions options = optionsOf(kind);
                StopRule rule;
                rule.passes = 1;
                tracing.setScene(scene);
                tracing.setView(view);
                tracing.setOptions(options);
                REQUIRE(tracing.render(rule).status.ok());
                options.centredFirstPass = true;
                noting.setScene(scene);
                noting.setView(view);
                noting.setOptions(options);
                rule.shouldStop = [](int tiles, double) { return tiles >= 2; };
                noting.render(rule);
                CHECK(noting.surfaceSamples().empty()); // only a part of them is recorded
                rule.shouldStop = {};
                rule.passes = 3; // the first pass records them
                REQUIRE(noting.render(rule).status.ok());

                const std::vector<SurfaceSample>& recorded = noting.surfaceSamples();
                const std::vector<SurfaceSample>& traced = tracing.surfaceSamples();
                REQUIRE(recorded.size() == traced.size());
                int kinds[3] = {}, nothing = 0;
                for (std::size_t i = 0; i < traced.size(); ++i)
                {
                    CAPTURE(i);
                    REQUIRE(recorded[i].normal == traced[i].normal);
                    REQUIRE(recorded[i].distance == traced[i].distance);
                    REQUIRE(recorded[i].albedo == traced[i].albedo);
                    REQUIRE(recorded[i].object == traced[i].object);
                    REQUIRE(recorded[i].lobe == traced[i].lobe);
                    REQUIRE(recorded[i].kind == traced[i].kind);
                    ++kinds[static_cast<int>(traced[i].kind)];
                    nothing += traced[i].object == 0;
                }
                CHECK(std::min({kinds[0], kinds[1], kinds[2], nothing}) > 0);
            }
        }
    }
}

TEST_CASE(
    "resolved image: what first samples met is what is seen there, and nothing is traced for it",
    "[session]")
{
    SceneBuilder builder = cornellBox();
    for (Material& material : builder.scene->materials)
        if (material.baseColor == Vec3(0.73f))
        {
            material.metallic = 1.0f;
            material.roughness = 0.4f;
        }
    const auto scene = builder.build();
    // The view is wider than the box: there is nothing at its sides.
    const View view =
        perspectiveView({278, 273, -800}, {278, 273, 279}, {0, 1, 0}, 40.0, kWidth, kHeight);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        RenderSession session(std::make_shared<Workers>(2));
        session.setScene(scene);
        session.setView(view);
        session.setKeepsSurfaces(true);
        RenderOptions options = optionsOf(kind);
        options.centredFirstPass = true;
        session.setOptions(options);
        StopRule rule;
        rule.passes = 1;
        REQUIRE(session.render(rule).status.ok());
        const std::vector<SurfaceSample>& samples = session.surfaceSamples();
        const SurfaceMap& map = session.surfaces();
        REQUIRE(map.isOf(view));
        const CameraRays& rays = map.rays.rays;
        int nothing = 0, glossy = 0;
        for (std::size_t i = 0; i < samples.size(); ++i)
        {
            CAPTURE(static_cast<int>(kind), i);
            const SurfaceSample& sample = samples[i];
            REQUIRE(map.object[i] == sample.object);
            REQUIRE(Vec3(map.normalX[i], map.normalY[i], map.normalZ[i]) == sample.normal);
            REQUIRE(map.lobe[i] == sample.lobe);
            const float x = static_cast<float>(i % kWidth) + 0.5f;
            const float y = static_cast<float>(i / kWidth) + 0.5f;
            const Vec3 ray = rays.direction + x * rays.directionDx + y * rays.directionDy;
            if (sample.object == 0)
                REQUIRE(map.along[i] == kInfinity);
            else
                REQUIRE(map.along[i] * glm::length(ray) == Approx(sample.distance).epsilon(1e-5));
            nothing += sample.object == 0;
            glossy += sample.lobe < 1.0f;
        }
        CHECK(nothing > 50);
        CHECK(glossy > 50);
    }
    RenderSession session(std::make_shared<Workers>(2));
    session.setScene(scene);
    session.setView(view);
    StopRule rule;
    rule.passes = 1;
    REQUIRE(session.render(rule).status.ok());
    CHECK(session.surfaces().view.width == 0); // surfaces were not asked for
}
