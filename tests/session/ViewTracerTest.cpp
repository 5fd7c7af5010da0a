// ViewTracerTest.cpp - frames under a budget, by a clock that each tile moves on: every picture
// that is presented is whole.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/session/BudgetScreen.h"

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("frame budget: a moving view is whole in each frame, of one resolution, in time",
          "[session]")
{
    Screen screen;
    References references(screen.inputs);
    std::vector<int> dividers;
    for (int i = 0; i < 30; ++i)
    {
        screen.frame(i);
        dividers.push_back(screen.tracer.frame().divider);
        const Screen::Tiles tiles = screen.tiles(i, references);
        CAPTURE(i, dividers.back());
        CHECK(tiles.torn == 0);
        CHECK(tiles.enlarged == 0);
        CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
        CHECK(screen.tracer.frame().traceSeconds > (i > 2 ? 0.7 : 0.2) * kBudget);
    }
    CHECK(dividers.back() > 1);
    CHECK(std::count(dividers.begin() + 2, dividers.end(), dividers.back()) == 28);
}

TEST_CASE("frame budget: at rest full resolution fills in, passes add up, then nothing is done",
          "[session]")
{
    Screen screen;
    References references(screen.inputs);
    for (int i = 0; i < 5; ++i)
        screen.frame(i);
    int before = 0, mixed = 0;
    bool whole = false;
    for (int i = 0;
         i < 100 && (screen.tracer.progress().passes < 3 || screen.tracer.frame().divider > 1); ++i)
    {
        screen.frame(4.0);
        if (screen.shown.width < kWidth) continue; // the view has not settled yet
        const Screen::Tiles tiles = screen.tiles(4.0, references);
        CAPTURE(i);
        CHECK(tiles.torn == 0);
        CHECK(tiles.traced >= before);
        CHECK((!whole || tiles.enlarged == 0));
        CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
        mixed += tiles.enlarged > 0;
        whole = tiles.enlarged == 0;
        before = tiles.traced;
    }
    CHECK(mixed > 3); // a frame has time for some 70 of 352 tiles
    CHECK(screen.tracer.progress().passes == 3);
    const Pixels& last = references.image(4.0, 1, 3, 0.0f);
    CHECK((screen.shown.rgba == last.rgba));
    CHECK((screen.shown.depth == last.depth));

    const uint64_t rays = screen.tracer.progress().rays.total();
    for (int i = 0; i < 3; ++i)
    {
        const double clock = screen.clock;
        screen.frame(4.0);
        CHECK_FALSE(screen.resolved);
        CHECK(screen.clock - clock < 10.0 * kTile); // looks at the clock, but no tile
    }
    CHECK(screen.tracer.progress().rays.total() == rays);
}

TEST_CASE("frame budget: moved, stopped, slowed down and redrawn at random no tile is ever torn",
          "[session]")
{
    Screen screen;
    References references(screen.inputs);
    std::mt19937 random(5);
    double x = 0.0;
    int stillFrames = 0, mixed = 0;
    for (int i = 0; i < 200; ++i)
    {
        if (stillFrames-- <= 0)
        {
            x = double(random() % 4); // also a place where it was before
            stillFrames = random() % 3 == 0 ? int(random() % 24) : 0;
        }
        screen.tileSeconds =
            random() % 10 == 0 ? 4.0 * kTile : kTile; // at times another program takes the machine
        screen.frame(x, random() % 20 != 0);
        const Screen::Tiles tiles = screen.tiles(x, references);
        CAPTURE(i, x, screen.tracer.frame().divider);
        mixed += tiles.enlarged > 0;
        REQUIRE(tiles.torn == 0);
    }
    CHECK(mixed > 5);
}

TEST_CASE(
    "frame budget: an exposure that changes while full resolution fills in is that of all tiles",
    "[session]")
{
    Screen screen;
    References references(screen.inputs);
    for (int i = 0; i < 3; ++i)
        screen.frame(i);
    for (int i = 0; i < 4; ++i)
        screen.frame(2.0);
    const Screen::Tiles before = screen.tiles(2.0, references);
    CHECK(before.enlarged > 100);
    const Pixels old = screen.shown;
    screen.inputs.exposureEv = 1.0f;
    screen.frame(2.0);
    CHECK(screen.tiles(2.0, references).traced > before.traced);
    for (int tile = 0; tile < kTiles; ++tile)
        CHECK_FALSE(sameTile(screen.shown, old, tile));
}

TEST_CASE("frame budget: copies of what is marked equal the whole, whatever changes", "[session]")
{
    Screen screen;
    std::mt19937 random(11);
    double x = 0.0;
    for (int i = 0; i < 300; ++i)
    {
        if (random() % 12 == 0) x = double(random() % 4);
        if (random() % 40 == 0) screen.upsampleShare = 0.2 - screen.upsampleShare;
        if (random() % 40 == 0) screen.inputs.exposureEv = float(random() % 2);
        if (random() % 40 == 0) screen.inputs.options.maxBounces = 1 + int(random() % 2);
        if (random() % 40 == 0)
            screen.inputs.denoise = random() % 3 ? DenoiseKind::Off : DenoiseKind::Filter;
        if (random() % 40 == 0) screen.degrade = random() % 3 != 0;
        if (random() % 60 == 0) screen.inputs.reprojects = random() % 2 != 0;
        if (random() % 60 == 0) screen.inputs.scene = cornellBox().build();
        screen.budget = random() % 30 == 0 ? 0.0 : kBudget;
        screen.frame(x, random() % 30 != 0); // a lost display requires a resolve
    }
    INFO(screen.copies << ", of colours alone " << screen.colorCopies);
    CHECK(screen.copies > 20);
    CHECK(screen.colorCopies > 20);
}

TEST_CASE("frame budget: the first image and one after a jump take a frame", "[session]")
{
    for (const double tile : {0.02, 0.3, 1.0, 3.0})
    {
        CAPTURE(tile);
        Screen screen(tile);
        screen.frame(0.0);
        CHECK(screen.tracer.hasImage());
        const double most = 1.1 * kBudget + 8.0 * tile;
        CHECK(screen.tracer.frame().seconds < most);
        for (int i = 0; i < 30; ++i)
            screen.frame(0.0);
        screen.frame(200.0);
        CHECK(screen.tracer.frame().seconds < most);
    }
}

TEST_CASE("frame budget: what becomes five times as slow is late once, not twice as much",
          "[session]")
{
    Screen screen(0.3);
    for (int i = 0; i < 20; ++i)
        screen.frame(i);
    screen.tileSeconds = 1.5;
    screen.frame(20.0);
    CHECK(screen.tracer.hasImage());
    CHECK(screen.tracer.frame().seconds < 2.0 * kBudget);
    for (int i = 21; i < 40; ++i)
    {
        screen.frame(i);
        CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
    }
}

TEST_CASE("frame budget: what becomes a third as slow takes all of its time at once", "[session]")
{
    Screen screen(0.9);
    screen.inputs.maxPasses = 100;
    for (int i = 0; i < 20; ++i)
        screen.frame(i);
    screen.tileSeconds = 0.3;
    for (int i = 20; i < 24; ++i)
    {
        screen.frame(i);
        CHECK(screen.tracer.frame().divider > 1);
        CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
        CHECK(screen.tracer.frame().traceSeconds > 0.85 * kBudget);
    }
}

TEST_CASE(
    "frame budget: without degrading a moving view is of full resolution, however long it takes",
    "[session]")
{
    Screen screen;
    References references(screen.inputs);
    screen.degrade = false;
    for (int i = 0; i < 4; ++i)
    {
        screen.frame(i);
        CHECK(screen.tracer.frame().divider == 1);
        CHECK(screen.tracer.progress().passes >= 1);
        CHECK(screen.tiles(i, references).traced == kTiles);
    }
    screen.frame(3.0); // at rest the budget is kept
    CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
}

TEST_CASE("frame budget: a scene that changes is not held by an image that is not shown",
          "[session]")
{
    Screen screen;
    for (int i = 0; i < 20; ++i)
        screen.frame(0.0); // both sessions have had the scene
    std::vector<std::weak_ptr<const TracedScene>> scenes;
    for (int i = 0; i < 4; ++i)
    {
        scenes.push_back(screen.inputs.scene);
        screen.inputs.scene = cornellBox().build();
        screen.frame(0.0);
    }
    CHECK(scenes[0].expired());
    CHECK(scenes[1].expired());
    CHECK(scenes[2].expired());
}

TEST_CASE("frame budget: none, then so many passes as are set, as ever", "[session]")
{
    Screen screen;
    screen.inputs.passesPerFrame = 2;
    for (const int expected : {2, 3, 3})
    {
        screen.tracer.trace(screen.inputs, viewAt(0.0));
        CHECK(screen.tracer.progress().passes == expected);
        CHECK(screen.tracer.displayWidth() == kWidth);
    }
}

TEST_CASE("frame budget: what fills in is not denoised: the picture under it is made once",
          "[session]")
{
    Screen screen;
    screen.inputs.denoise = DenoiseKind::Filter;
    for (int frame = 0; frame < 6; ++frame)
        screen.frame(10.0 * frame);
    REQUIRE(screen.tracer.frame().divider > 1);
    Pixels before;
    int fillingIn = 0, made = 0;
    for (int frame = 0; frame < 40 && screen.tracer.frame().divider > 1; ++frame)
    {
        screen.frame(50.0);
        const bool fills = screen.shown.width == kWidth && screen.tracer.frame().divider > 1;
        if (fills)
        {
            ++fillingIn;
            made += screen.resolved;
            if (fillingIn > 1) CHECK(screen.shown.rgba == before.rgba);
        }
        before = screen.shown;
    }
    CHECK(fillingIn > 2);
    CHECK(made == 1);
    // The whole image is denoised, and so is each image of a further pass.
    REQUIRE(screen.tracer.frame().divider == 1);
    CHECK(screen.resolved);
}
