// ChangedTilesTest.cpp - marks of tiles as rectangles, and the order that keeps marks together.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/TileOrder.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

constexpr int kSizes[][2] = {{1, 1}, {16, 16}, {17, 33}, {340, 250}, {1920, 1080}};

/// Counts the rectangles that cover each pixel.
std::vector<int> covered(const std::vector<PixelRect>& rects, int width, int height)
{
    std::vector<int> counts(std::size_t(width * height));
    for (const PixelRect& rect : rects)
    {
        REQUIRE((rect.x >= 0 && rect.y >= 0 && rect.width > 0 && rect.height > 0));
        REQUIRE((rect.x + rect.width <= width && rect.y + rect.height <= height));
        for (int y = rect.y; y < rect.y + rect.height; ++y)
            for (int x = rect.x; x < rect.x + rect.width; ++x)
                ++counts[std::size_t(y * width + x)];
    }
    return counts;
}

bool isWhole(const std::vector<PixelRect>& rects, int width, int height)
{
    return rects.size() == 1 && rects[0].width == width && rects[0].height == height;
}

} // namespace

TEST_CASE("changed tiles: their rectangles hold each of them once and nothing else, or are all",
          "[film]")
{
    std::mt19937 random(7);
    int parts = 0;
    for (const auto& [width, height] : kSizes)
        for (const unsigned share : {0u, 1u, 2u, 10u, 50u, 90u, 100u})
        {
            ChangedTiles changed;
            changed.reset(width, height);
            for (uint8_t& mark : changed.color)
                mark = random() % 100 < share;
            const std::vector<PixelRect> rects = changedRects(changed.color, width, height);
            const std::vector<int> counts = covered(rects, width, height);
            CHECK(changedRects(changed.depth, width, height).empty());
            const bool whole = isWhole(rects, width, height);
            parts += !whole;
            std::size_t wrong = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                {
                    const auto tile =
                        std::size_t(y / kTileSize * tilesAlong(width) + x / kTileSize);
                    const int expected = whole ? 1 : changed.color[tile];
                    wrong += counts[std::size_t(y * width + x)] != expected;
                }
            CAPTURE(width, height, share);
            CHECK(wrong == 0);
        }
    CHECK(parts >= 10);
}

TEST_CASE("changed tiles: squares of them are rectangles of their own, marks add up", "[film]")
{
    ChangedTiles a, b;
    a.reset(320, 160);
    b.reset(320, 160);
    for (const int tile : {0, 1, 20, 21})
        a.color[std::size_t(tile)] = 1;
    for (const int tile : {2, 22, 119})
        b.color[std::size_t(tile)] = b.depth[std::size_t(tile)] = 1;
    a.add(b);
    const std::vector<PixelRect> rects = changedRects(a.color, 320, 160);
    REQUIRE(rects.size() == 2);
    CHECK((rects[0].x == 0 && rects[0].y == 0 && rects[0].width == 48 && rects[0].height == 32));
    CHECK((rects[1].x == 304 && rects[1].y == 80 && rects[1].width == 16 && rects[1].height == 16));
    CHECK(changedRects(a.depth, 320, 160).size() == 2);
}

TEST_CASE("tile order: grouped, each tile once, squares together and all over the image", "[film]")
{
    for (const std::size_t across : {1u, 4u, 22u, 120u})
        for (const std::size_t up : {1u, 3u, 16u, 68u})
            for (const std::size_t group : {1u, 2u, 4u})
            {
                CAPTURE(across, up, group);
                const TileOrder order(across, up, group);
                std::vector<int> seen(across * up);
                std::size_t together = 0, last = across * up;
                for (std::size_t i = 0; i < order.places(); ++i)
                {
                    const std::size_t tile = order.tile(i);
                    REQUIRE(tile <= across * up);
                    if (tile == across * up) continue;
                    ++seen[tile];
                    together += tile == last + 1;
                    last = tile;
                }
                CHECK(std::count(seen.begin(), seen.end(), 1) == static_cast<int>(seen.size()));
                if (group == 4 && across == 120) CHECK(together >= seen.size() * 3 / 4);
            }

    // The tiles are the first eighth of 1920 x 1080 pixels, by quarters of the image from the
    // bottom to the top.
    const TileOrder order(120, 68, 4);
    int quarters[4] = {};
    for (std::size_t i = 0; i < order.places() / 8; ++i)
        ++quarters[std::min<std::size_t>(order.tile(i), 8159) / 2040];
    for (const int quarter : quarters)
        CHECK(std::abs(quarter - 255) <= 40);
}
