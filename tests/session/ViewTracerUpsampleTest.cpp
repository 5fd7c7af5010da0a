// ViewTracerUpsampleTest.cpp - reduced pictures that are upsampled within the frame budget.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/session/BudgetScreen.h"

#include "osgRayTrace/session/upsample/Upsample.h"

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("frame budget: reduced pictures are upsampled where there is time for it", "[session]")
{
    Screen screen;
    screen.upsampleShare = 0.2;
    screen.inputs.maxPasses = 1;
    for (int i = 0; i < 6; ++i)
    {
        screen.frame(i);
        const int divider = screen.tracer.frame().divider;
        REQUIRE(divider > 1);
        RenderOptions options = screen.inputs.options;
        options.centredFirstPass = true;
        View view = viewAt(i);
        view.width = reducedSize(kWidth, divider);
        view.height = reducedSize(kHeight, divider);
        RenderSession session(std::make_shared<Workers>(1));
        session.setScene(screen.inputs.scene);
        session.setView(view);
        session.setOptions(options);
        StopRule rule;
        rule.passes = 1;
        REQUIRE(session.render(rule).status.ok());
        Pixels expected;
        expected.resize(kWidth, kHeight);
        session.presentUpsampled(session.resolvedImage(), session.surfaceSamples(), kWidth, kHeight,
                                 {{}, expected.rgba.data(), expected.depth.data()}, kAllTraced);
        REQUIRE(screen.shown.width == kWidth);
        CHECK((screen.shown.rgba == expected.rgba));
        CHECK((screen.shown.depth == expected.depth));
    }
    screen.upsampleShare = 1e-9; // upsampling took longer than this share
    screen.frame(6.0);
    CHECK(screen.shown.width < kWidth);
}

TEST_CASE("frame budget: reduced pictures are upsampled as far as there is time for it",
          "[session]")
{
    Screen screen;
    screen.upsampleShare = 0.2;
    const double half = 0.4 * kBudget / (kWidth * kHeight); // half size: a tenth of the budget
    double x = 0.0;
    const auto widthAfter = [&](int frames, double pixelSeconds)
    {
        screen.upsamplePixelSeconds = pixelSeconds;
        for (int i = 0; i < frames; ++i)
            screen.frame(x += 1.0);
        REQUIRE(screen.tracer.frame().divider > 2);
        return screen.shown.width;
    };
    CHECK(widthAfter(30, half) == reducedSize(kWidth, 2));
    for (int i = 0; i < 20; ++i)
    {
        CHECK(widthAfter(1, half) == reducedSize(kWidth, 2));
        CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
        CHECK(screen.tracer.frame().traceSeconds > 0.7 * kBudget);
    }
    // Full size is the next step; its cost is known before it is done.
    screen.upsamplePixelSeconds = half / 5.0;
    do
    {
        screen.frame(x += 1.0);
        CHECK(screen.tracer.frame().seconds < 1.04 * kBudget);
    } while (screen.shown.width < kWidth && x < 100.0);
    CHECK(screen.shown.width == kWidth);
    CHECK(widthAfter(30, 1e3 * half) == reducedSize(kWidth, screen.tracer.frame().divider));
    // The cost of upsampling is learnt only while it is done.
    CHECK(widthAfter(800, half) == reducedSize(kWidth, 2));

    // At rest the tiles of full resolution are laid over the upsampled picture.
    screen.frame(x);
    screen.reduced = Pixels();
    screen.reduced.resize(kWidth, kHeight);
    Pixels small = screen.shown;
    REQUIRE(small.width < kWidth);
    enlarge({small.width, small.height, small.rgba.data(), small.depth.data()},
            {kWidth, kHeight, screen.reduced.rgba.data(), screen.reduced.depth.data()}, Workers(1));
    screen.frame(x);
    REQUIRE(screen.shown.width == kWidth);
    int kept = 0;
    for (int tile = 0; tile < kTiles; ++tile)
        kept += sameTile(screen.shown, screen.reduced, tile);
    CHECK(kept > 0);
    CHECK(kept < kTiles);
}

TEST_CASE("frame budget: tiles laid over the upsampled picture make that of a full resolve",
          "[session]")
{
    Screen screen;
    screen.upsampleShare = 0.2;
    for (int i = 0; i < 4; ++i)
        screen.frame(i);
    int laid = 0;
    for (int i = 0; i < 30; ++i)
    {
        screen.frame(3.0);
        const bool mixed = screen.tracer.frame().divider > 1 && i >= 1;
        CAPTURE(i);
        if (mixed) CHECK_FALSE(screen.resolved); // not even in the first of these frames
        laid += mixed;
        CHECK(same(screen.shown, screen.whole()));
    }
    CHECK(laid > 3);
    CHECK(screen.colorCopies > 3); // depths come from the first pass alone
}

TEST_CASE("frame budget: after a jump there is time for upsampling", "[session]")
{
    Screen screen;
    screen.upsampleShare = 0.2;
    screen.upsampleSeconds = 12.0;
    for (int i = 0; i < 6; ++i)
        screen.frame(i);
    for (const double x : {200.0, -100.0, 50.0})
    {
        for (int i = 0; i < 25; ++i)
        {
            screen.frame(screen.at);
            CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
        }
        CHECK(screen.tracer.frame().divider == 1);
        screen.frame(x);
        CHECK(screen.tracer.frame().divider > 1);
        CHECK(screen.resolved);
        CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
        CHECK(screen.tracer.frame().traceSeconds > 0.7 * kBudget);
    }
}
