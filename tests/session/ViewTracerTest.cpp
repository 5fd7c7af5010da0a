// ViewTracerTest.cpp - frames under a budget, by a clock that each tile moves on: every picture
// that is presented is whole.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/Enlarge.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 340, kHeight = 250, kTiles = 352;
constexpr double kBudget = 80.0, kTile = 1.0; // of a tile, and of each other look at the clock

View viewAt(double x)
{
    return perspectiveView({278 + x, 278, 20}, {278, 250, 559}, {0, 1, 0}, 50.0, kWidth, kHeight);
}

struct Pixels
{
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;
    std::vector<float> depth;

    void resize(int w, int h)
    {
        width = w;
        height = h;
        rgba.assign(4 * std::size_t(w * h), uint8_t(123)); // the former values are lost
        depth.assign(std::size_t(w * h), 0.123f);
    }
};

bool same(const Pixels& a, const Pixels& b)
{
    return a.width == b.width && a.height == b.height && a.rgba == b.rgba && a.depth == b.depth;
}

void copyRects(const std::vector<PixelRect>& rects, const Pixels& from, Pixels& to, bool depth)
{
    for (const PixelRect& rect : rects)
        for (int y = rect.y; y < rect.y + rect.height; ++y)
        {
            const auto first = std::size_t(y * from.width + rect.x),
                       count = std::size_t(rect.width);
            if (depth)
                std::copy_n(&from.depth[first], count, &to.depth[first]);
            else
                std::copy_n(&from.rgba[4 * first], 4 * count, &to.rgba[4 * first]);
        }
}

bool sameTile(const Pixels& a, const Pixels& b, int tile)
{
    const int across = (a.width + kTileSize - 1) / kTileSize;
    const int left = tile % across * kTileSize, bottom = tile / across * kTileSize;
    for (int y = bottom; y < std::min(bottom + kTileSize, a.height); ++y)
        for (int x = left; x < std::min(left + kTileSize, a.width); ++x)
        {
            const auto p = std::size_t(y * a.width + x);
            if (std::memcmp(&a.rgba[4 * p], &b.rgba[4 * p], 4) != 0 || a.depth[p] != b.depth[p])
                return false;
        }
    return true;
}

/// Keeps the images of all passes of a view, made by a session that nobody interrupts.
class References
{
public:
    explicit References(const ViewInputs& inputs) : _traced(inputs.scene), _options(inputs.options)
    {
    }

    const Pixels& image(double x, int divider, int passes, float exposure)
    {
        Pixels& pixels = _images[{x, divider, passes, exposure}];
        if (pixels.width > 0) return pixels;
        View view = viewAt(x);
        view.width = reducedSize(kWidth, divider);
        view.height = reducedSize(kHeight, divider);
        pixels.resize(view.width, view.height);
        RenderSession session(std::make_shared<Workers>(1));
        session.setScene(_traced);
        session.setView(view);
        RenderOptions options = _options;
        options.centredFirstPass = divider > 1;
        session.setOptions(options);
        StopRule rule;
        rule.passes = passes;
        session.render(rule);
        session.resolveDisplay({exposure, false}, pixels.rgba.data(), pixels.depth.data());
        return pixels;
    }

private:
    std::shared_ptr<const TracedScene> _traced;
    RenderOptions _options;
    std::map<std::tuple<double, int, int, float>, Pixels> _images;
};

/// A viewer without OpenGL, which does what RayTraceDrawable does.
struct Screen
{
    explicit Screen(double tile = kTile) : tileSeconds(tile), tracer([this] { return look(); })
    {
        inputs.options.integrator = IntegratorKind::Path;
        inputs.options.maxBounces = 1;
        inputs.maxPasses = 3;
        inputs.scene = cornellBox().build();
        inputs.workers = std::make_shared<Workers>(1);
        inputs.photons = std::make_shared<PhotonPasses>();
    }

    double look()
    {
        if (resolveLooks > 0 && --resolveLooks == 0) // the look after upsampling
            clock += upsamplePixelSeconds * display.width * display.height;
        return clock += tileSeconds;
    }

    void frame(double x, bool keepsDisplay = true)
    {
        at = x;
        FrameBudget frameBudget;
        frameBudget.seconds = budget;
        frameBudget.degrade = degrade;
        frameBudget.upsampleShare = upsampleShare;
        if (!keepsDisplay) display = Pixels();
        const bool fits = display.width == kWidth && display.height == kHeight;
        const bool written =
            tracer.trace(inputs, viewAt(x), frameBudget, fits ? display.rgba.data() : nullptr,
                         fits ? display.depth.data() : nullptr);
        resolved = tracer.needsResolve(inputs);
        if (resolved)
        {
            if (tracer.displayWidth() != display.width || tracer.displayHeight() != display.height)
                display.resize(tracer.displayWidth(), tracer.displayHeight());
            resolveLooks = 2;
            tracer.resolve(display.rgba.data(), display.depth.data());
            resolveLooks = 0;
            if (upsampleShare > 0.0 && display.width == kWidth) clock += upsampleSeconds;
        }
        if (resolved)
        {
            shown = display;
        }
        else if (written)
        {
            const ChangedTiles& changed = tracer.changed();
            REQUIRE((changed.width == kWidth && changed.height == kHeight));
            copyRects(changedRects(changed.color, kWidth, kHeight), display, shown, false);
            copyRects(changedRects(changed.depth, kWidth, kHeight), display, shown, true);
            ++(std::count(changed.depth.begin(), changed.depth.end(), 1) ? copies : colorCopies);
        }
        if (resolved || written) REQUIRE(same(shown, display));
        if (shown.width < kWidth) reduced = shown;
        tracer.recordPresented();
    }

    /// The tiles of the picture: those of a whole pass, those of the enlarged reduced picture, and
    /// those that are neither.
    struct Tiles
    {
        int traced = 0, enlarged = 0, torn = 0;
    };
    Tiles tiles(double x, References& references) const
    {
        Tiles result;
        const bool small = shown.width < kWidth;
        const int divider = small ? tracer.frame().divider : 1;
        Pixels under;
        if (!small && reduced.width > 0)
        {
            under.resize(kWidth, kHeight);
            Pixels from = reduced;
            enlarge({from.width, from.height, from.rgba.data(), from.depth.data()},
                    {kWidth, kHeight, under.rgba.data(), under.depth.data()}, Workers(1));
        }
        for (int tile = 0; tile < tilesOf(shown.width, shown.height); ++tile)
        {
            bool traced = false;
            for (int pass = 1; pass <= inputs.maxPasses && !traced; ++pass)
            {
                const Pixels& whole = references.image(x, divider, pass, inputs.exposureEv);
                traced = whole.width == shown.width && sameTile(shown, whole, tile);
            }
            const bool enlarged = !traced && under.width > 0 && sameTile(shown, under, tile);
            result.traced += traced;
            result.enlarged += enlarged;
            result.torn += !traced && !enlarged;
        }
        return result;
    }

    double clock = 0.0, tileSeconds;
    double at = 0.0; ///< x of the last frame
    double budget = kBudget;
    bool degrade = true;
    double upsampleSeconds = 0.0;      ///< cost of upsampling, beside looks at the clock
    double upsamplePixelSeconds = 0.0; ///< cost of upsampling, for a pixel of its result
    int resolveLooks = 0;              ///< looks that are still to come in a resolve
    double upsampleShare = 0.0;        ///< 0: reduced pictures are presented as they are
    ViewInputs inputs;
    ViewTracer tracer;
    /// Returns what a full resolve makes of the present image.
    Pixels whole()
    {
        Pixels pixels;
        pixels.resize(tracer.displayWidth(), tracer.displayHeight());
        tracer.resolve(pixels.rgba.data(), pixels.depth.data());
        return pixels;
    }

    /// shown holds copies of the changed rectangles of display; reduced is the last picture of
    /// reduced size.
    Pixels display, shown, reduced;
    bool resolved = false;
    int copies = 0, colorCopies = 0; ///< of changed rectangles
};

} // namespace

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
                                 {{}, expected.rgba.data(), expected.depth.data()},
                                 ImageStages::kMostTraced);
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
