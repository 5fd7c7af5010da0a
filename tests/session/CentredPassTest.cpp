// CentredPassTest.cpp - the first pass of images that are filtered by their first hits.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/image/ResolvedImage.h"
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

float redOf(const ResolvedImage& image, int x, int y)
{
    return image.radiance[4 * static_cast<std::size_t>(y * image.width + x)];
}

} // namespace

TEST_CASE("centred first pass: it sees what first hits are sampled of, later ones their own points",
          "[session][upsample]")
{
    // The scene has emission alone, of two halves with a slanted edge: a sample tells which half it
    // is from.
    SceneBuilder builder;
    builder.add(quadMesh({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), lamp(Vec3(0.25f)));
    builder.add(quadMesh({-9, -9, 0}, {8, 0, 0}, {3, 18, 0}), lamp(Vec3(1.0f)));
    const auto scene = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
        for (const bool centred : {true, false})
        {
            RenderSession session(std::make_shared<Workers>(2));
            RenderOptions options = optionsOf(kind);
            options.centredFirstPass = centred;
            session.setScene(scene);
            session.setView(perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 50.0, 60, 200));
            session.setOptions(options);
            StopRule rule;
            rule.passes = 1;
            session.render(rule);
            const ResolvedImage first = session.resolvedImage();
            const std::vector<SurfaceSample> samples = session.surfaceSamples();
            int other = 0;
            for (int y = 0; y < 200; ++y)
                for (int x = 0; x < 60; ++x)
                    other += (redOf(first, x, y) > 0.5f) !=
                             (samples[static_cast<std::size_t>(60 * y + x)].object == 2);
            CHECK((other == 0) == centred);
            rule.passes = 9;
            session.render(rule);
            const ResolvedImage later = session.resolvedImage();
            int between = 0; // pixels of the edge see both halves
            for (int y = 0; y < 200; ++y)
                for (int x = 0; x < 60; ++x)
                    between += redOf(later, x, y) > 0.3f && redOf(later, x, y) < 0.95f;
            CHECK(between > 50);
        }
}
