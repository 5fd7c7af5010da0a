// ShownImageTest.cpp - images that take the long way to the display are those that take the short one.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include <cstdlib>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 37, kHeight = 21;

/// A lit plane that fills half of the view.
std::shared_ptr<const TracedScene> litPlane(bool displayReferred)
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {4, 0, 0}, {0, 8, 0}), lambert(Vec3(0.2f, 0.4f, 0.6f)));
    builder.scene->lights.push_back(pointLight({-1, 0, 3}, Vec3(9.0f)));
    builder.scene->displayReferred = displayReferred;
    return builder.build();
}

} // namespace

TEST_CASE("shown image: display values and depths are those of resolveDisplay", "[session]")
{
    for (const bool displayReferred : {false, true})
    {
        RenderSession session(std::make_shared<Workers>(2));
        CHECK(session.shownImage().width == 0);
        CHECK(session.surfaceSamples().empty());
        session.setScene(litPlane(displayReferred));
        session.setView(perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, kWidth, kHeight));
        session.setOptions(optionsOf(IntegratorKind::Whitted));
        for (const int passes : {1, 3})
        {
            StopRule rule;
            rule.passes = passes;
            REQUIRE(session.render(rule).status.ok());
            const ShownImage image = session.shownImage();
            CHECK(image.error.size() == (passes < 2 ? 0u : 3u * kWidth * kHeight));
            for (const float exposure : {0.0f, -1.5f})
            {
                const ToneMap toneMap{exposure, displayReferred};
                std::vector<uint8_t> expected(4 * kWidth * kHeight), shown(4 * kWidth * kHeight);
                std::vector<float> expectedDepth(kWidth * kHeight), depth(kWidth * kHeight);
                session.resolveDisplay(toneMap, expected.data(), expectedDepth.data());
                showImage(image, toneMap, Workers(2), shown.data(), depth.data());
                CHECK(depth == expectedDepth);
                int brightest = 0, largest = 0;
                for (std::size_t i = 0; i < shown.size(); ++i)
                {
                    if (i % 4 != 3) brightest = std::max(brightest, int(shown[i]));
                    largest = std::max(largest, std::abs(shown[i] - expected[i]));
                }
                CHECK(brightest > 40);
                CHECK(largest <= (displayReferred ? 1 : 0)); // its values are decoded and encoded again
            }
        }
    }
}

TEST_CASE("shown image: samples of surfaces are the channels of the first hit", "[session]")
{
    RenderSession session(std::make_shared<Workers>(2));
    session.setScene(litPlane(false));
    session.setView(perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, kWidth, kHeight));
    session.setOptions(optionsOf(IntegratorKind::Whitted));
    StopRule rule;
    rule.passes = 1;
    REQUIRE(session.render(rule).status.ok());
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
