// InterruptedPassTest.cpp - passes that are spread over many calls, tile by tile.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/film/Film.h"

#include <algorithm>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 100, kHeight = 70;
constexpr std::size_t kPixels = kWidth * kHeight;

struct Display
{
    std::vector<uint8_t> rgba = std::vector<uint8_t>(4 * kPixels);
    std::vector<float> depth = std::vector<float>(kPixels);

    DisplayTarget target(bool holdsImage)
    {
        return {ToneMap(), rgba.data(), depth.data(), holdsImage};
    }
};

/// Returns a view from within the box, so that there is noise in each tile.
View insideView()
{
    return perspectiveView({278, 278, 20}, {278, 250, 559}, {0, 1, 0}, 50.0, kWidth, kHeight);
}

/// A box with a mirror and glass, so that there are caustics.
struct Room
{
    explicit Room(IntegratorKind kind, int threads = 2)
        : session(std::make_shared<Workers>(threads))
    {
        SceneBuilder builder = cornellBox();
        builder.add(sphereMesh(Vec3(400, 120, 120), 60.0f, 24), glass(1.5f));
        builder.add(sphereMesh(Vec3(100, 300, 300), 60.0f, 24), mirror(Vec3(0.9f)));
        session.setScene(builder.build());
        session.setView(insideView());
        RenderOptions options = optionsOf(kind, 4);
        options.photons = 4000;
        session.setOptions(options);
    }

    RenderSession session;
};

/// Returns the rule that lets a call begin this many tiles.
StopRule someTiles(int passes, int tiles)
{
    StopRule rule;
    rule.passes = passes;
    rule.shouldStop = [tiles](int begun, double) { return begun >= tiles; };
    return rule;
}

void copyMarked(const Display& from, Display& to, const ChangedTiles& changed)
{
    for (std::size_t p = 0; p < kPixels; ++p)
    {
        const std::size_t tile = p / kWidth / kTileSize * 7 + p % kWidth / kTileSize;
        if (changed.color[tile]) std::copy_n(&from.rgba[4 * p], 4, &to.rgba[4 * p]);
        if (changed.depth[tile]) to.depth[p] = from.depth[p];
    }
}

/// Returns whether the tile that begins at the pixel is the same in both displays.
bool sameTile(const Display& a, const Display& b, int tileX, int tileY)
{
    for (int y = tileY; y < std::min(tileY + kTileSize, kHeight); ++y)
        for (int x = tileX; x < std::min(tileX + kTileSize, kWidth); ++x)
        {
            const auto p = static_cast<std::size_t>(y * kWidth + x);
            if (!std::equal(&a.rgba[4 * p], &a.rgba[4 * p] + 4, &b.rgba[4 * p]) ||
                a.depth[p] != b.depth[p])
                return false;
        }
    return true;
}

} // namespace

TEST_CASE("interrupted passes: bit by bit the image of an uninterrupted render", "[session]")
{
    for (const IntegratorKind kind :
         {IntegratorKind::Path, IntegratorKind::Whitted, IntegratorKind::Ppm, IntegratorKind::Sppm,
          IntegratorKind::PhotonCaustics})
    {
        CAPTURE(int(kind));
        constexpr int kPasses = 7; // includes passes whose photons are guided
        Room calm(kind), spread(kind);
        StopRule rule;
        rule.passes = kPasses;
        calm.session.render(rule);
        int calls = 0;
        for (; spread.session.progress().passes < kPasses; ++calls)
        {
            const RenderProgress result =
                spread.session.render(someTiles(kPasses, 1 + calls * 5 % 17));
            REQUIRE(result.status.ok());
            REQUIRE(result.newTiles >= 1);
            REQUIRE(calls < 1000);
        }
        CHECK(calls > kPasses);
        CHECK(spread.session.resolveRadiance() == calm.session.resolveRadiance());
        CHECK(spread.session.progress().rays.total() == calm.session.progress().rays.total());
        CHECK(spread.session.tilesLeft() == 35);                           // of the next pass
        CHECK(spread.session.render(someTiles(kPasses, 5)).newTiles == 0); // all passes are done
    }
}

TEST_CASE(
    "interrupted passes: each tile that is shown is that of some whole pass, the rest is as it was",
    "[session]")
{
    constexpr int kPasses = 3, kMost = 14;
    std::vector<Display> whole(kPasses + 1);
    std::fill(whole[0].rgba.begin(), whole[0].rgba.end(), uint8_t(77)); // the former picture
    std::fill(whole[0].depth.begin(), whole[0].depth.end(), 0.25f);
    Room calm(IntegratorKind::Path);
    for (int pass = 1; pass <= kPasses; ++pass)
    {
        StopRule rule;
        rule.passes = pass;
        DisplayTarget target = whole[static_cast<std::size_t>(pass)].target(false);
        calm.session.render(rule, {}, &target);
    }

    for (const int threads : {1, 2})
    {
        Room spread(IntegratorKind::Path, threads);
        Display display = whole[0], copy = whole[0];
        std::vector<int> passOf(35); // by tile
        for (int call = 0; spread.session.progress().passes < kPasses; ++call)
        {
            StopRule rule = someTiles(kPasses, 1 + call % kMost);
            rule.newPasses = 1 + call % 3;
            rule.groupedTiles = 1 << call % 3;
            ChangedTiles changed;
            changed.reset(kWidth, kHeight);
            DisplayTarget target = display.target(true);
            target.changed = &changed;
            const RenderProgress result = spread.session.render(rule, {}, &target);
            copyMarked(display, copy, changed);
            REQUIRE(copy.rgba == display.rgba); // unmarked tiles are not written
            REQUIRE(copy.depth == display.depth);
            int sum = 0;
            for (int tile = 0; tile < 35; ++tile)
            {
                int& pass = passOf[static_cast<std::size_t>(tile)];
                const int before = pass;
                while (pass <= kPasses && !sameTile(display, whole[static_cast<std::size_t>(pass)],
                                                    tile % 7 * kTileSize, tile / 7 * kTileSize))
                    ++pass;
                REQUIRE(pass <= kPasses); // otherwise the tile is torn
                sum += pass - before;
            }
            REQUIRE(sum == result.newTiles); // the display has each tile that was traced
            REQUIRE(*std::max_element(passOf.begin(), passOf.end()) <=
                    *std::min_element(passOf.begin(), passOf.end()) + 1);
        }
        CHECK(display.rgba == whole[kPasses].rgba);
        CHECK(display.depth == whole[kPasses].depth);
    }
}

TEST_CASE("interrupted passes: shouldStop is asked before passes, with the photons' time",
          "[session]")
{
    Room room(IntegratorKind::PhotonCaustics);
    std::vector<double> ahead;
    StopRule rule;
    rule.passes = 7;
    rule.shouldStop = [&](int tiles, double seconds)
    {
        if (tiles % 35 == 0 && tiles > 0 && seconds > 0.0)
            ahead.push_back(seconds); // the time of this thread's photons
        return false;
    };
    CHECK(room.session.render(rule).newTiles == 7 * 35);
    CHECK(ahead.size() == 6); // all but the first pass, which must have photons

    View moved = insideView();
    moved.viewFromWorld[3][0] += 5.0;
    room.session.setView(moved);
    ahead.clear();
    rule.passes = 4;
    CHECK(room.session.render(rule).newTiles == 4 * 35);
    CHECK(ahead.empty()); // the first four passes are kept
}

TEST_CASE("interrupted passes: so many tiles as are allowed, by any number of threads, and the "
          "same image",
          "[session]")
{
    Room whole(IntegratorKind::Path);
    StopRule all;
    all.passes = 3;
    whole.session.render(all);
    for (const int threads : {1, 2, 5})
    {
        Room room(IntegratorKind::Path, threads);
        StopRule some;
        some.passes = 3;
        some.newTiles = 13; // of 35
        for (int done = 0; done < 3 * 35; done += 13)
        {
            const RenderProgress result = room.session.render(some);
            CAPTURE(threads, done);
            CHECK(result.newTiles == std::min(13, 3 * 35 - done));
            CHECK(result.passes == std::min(done + 13, 3 * 35) / 35);
        }
        CHECK(room.session.resolveRadiance() == whole.session.resolveRadiance());
    }
}

TEST_CASE("interrupted passes: what is not shown in the pass is shown at the end", "[session]")
{
    // keepGoing ends the render after the first pass, although more passes were allowed.
    Room room(IntegratorKind::Whitted);
    Display shown, expected;
    DisplayTarget target = shown.target(false);
    StopRule rule;
    rule.passes = 5;
    room.session.render(
        rule, [](const RenderProgress&) { return false; }, &target);
    CHECK(room.session.progress().passes == 1);
    room.session.resolveDisplay(ToneMap(), expected.rgba.data(), expected.depth.data());
    CHECK(shown.rgba == expected.rgba);
    CHECK(shown.depth == expected.depth);
}

TEST_CASE("session: cleared it holds no scene", "[session]")
{
    auto traced = cornellBox().build();
    const std::weak_ptr<const TracedScene> watched = traced;
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(traced);
    session.setView(cornellView(20, 20));
    session.setOptions(optionsOf(IntegratorKind::Path, 3));
    StopRule rule;
    rule.passes = 2;
    session.render(rule);
    const std::vector<float> before = session.resolveRadiance();
    traced.reset();
    CHECK_FALSE(watched.expired());
    session.clear();
    CHECK(watched.expired());
    CHECK(session.progress().passes == 0);
    CHECK(session.resolvedImage().width == 0);
    session.setScene(cornellBox().build());
    CHECK(session.render(rule).restarted);
    CHECK(session.resolveRadiance() == before);
}
