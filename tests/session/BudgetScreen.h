// BudgetScreen.h - a viewer without OpenGL whose frames have a budget, by a clock that each tile
// moves on. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

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
#include <tuple>
#include <vector>

namespace osgRayTrace::engine::test
{

constexpr int kWidth = 340, kHeight = 250, kTiles = 352;
constexpr double kBudget = 80.0, kTile = 1.0; // of a tile, and of each other look at the clock

inline View viewAt(double x)
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

inline bool same(const Pixels& a, const Pixels& b)
{
    return a.width == b.width && a.height == b.height && a.rgba == b.rgba && a.depth == b.depth;
}

inline void copyRects(const std::vector<PixelRect>& rects, const Pixels& from, Pixels& to,
                      bool depth)
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

inline bool sameTile(const Pixels& a, const Pixels& b, int tile)
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
        session.setCentred(divider > 1);
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

} // namespace osgRayTrace::engine::test
