// ResolveTest.cpp - from tiles to images: pixel positions, tone map, display bytes.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/film/Resolve.h"

#include <array>
#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a film of one pass whose red and depth are value(x, y).
template <class Value> Film filmOf(int width, int height, const Value& value)
{
    Film film;
    film.reset(width, height);
    film.beginPass();
    for (int tile = 0; tile < film.tileCount(); ++tile)
    {
        TileRgba values;
        for (int b = 0; b < kTileBlocks; ++b)
        {
            for (int i = 0; i < kLanes; ++i)
            {
                const float v =
                    value(film.tileX(tile) + laneX(b, i), film.tileY(tile) + laneY(b, i));
                values[b].r[i] = v;
                values[b].g[i] = 2.0f * v;
                values[b].b[i] = 3.0f * v;
                values[b].a[i] = 1.0f;
                film.depth(tile)[b * kLanes + i] = v;
            }
        }
        film.addPass(tile, film.tilePasses(tile), values);
    }
    return film;
}

double exactSrgb(double x)
{
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

} // namespace

TEST_CASE("resolve: each pixel lands in its row and column, whatever the size", "[film]")
{
    for (const auto& [width, height] : {std::pair(16, 16), std::pair(1, 1), std::pair(17, 33),
                                        std::pair(40, 5), std::pair(1, 50)})
    {
        CAPTURE(width, height);
        const auto value = [width = width](int x, int y) { return float(x + y * width) / 8192.0f; };
        const Film film = filmOf(width, height, value);
        const auto pixels = static_cast<std::size_t>(width * height);
        // One more value stands behind each image and must not change.
        std::vector<float> radiance(4 * pixels + 1, -1.0f), depth(pixels + 1, -1.0f),
            displayDepth(pixels + 1, -1.0f);
        std::vector<uint8_t> bytes(4 * pixels + 1, 77);
        ToneMap asIs;
        asIs.displayReferred = true;
        for (int tile = 0; tile < film.tileCount(); ++tile)
        {
            resolveTileRadiance(film, tile, false, radiance.data());
            resolveTileDepth(film, tile, depth.data());
            resolveTileDisplay(film, tile, asIs, bytes.data(), displayDepth.data());
        }
        for (int y = 0; y < height; ++y)
        {
            for (int x = 0; x < width; ++x)
            {
                const auto at = static_cast<std::size_t>(y * width + x);
                REQUIRE(radiance[4 * at] == value(x, y));
                REQUIRE(radiance[4 * at + 1] == 2.0f * value(x, y));
                REQUIRE(radiance[4 * at + 2] == 3.0f * value(x, y));
                REQUIRE(radiance[4 * at + 3] == 1.0f);
                REQUIRE(depth[at] == value(x, y));
                REQUIRE(displayDepth[at] == value(x, y));
                REQUIRE(int(bytes[4 * at + 2]) ==
                        int(std::min(1.0f, 3.0f * value(x, y)) * 255.0f + 0.5f));
                REQUIRE(int(bytes[4 * at + 3]) == 255);
            }
        }
        CHECK(radiance.back() == -1.0f);
        CHECK(depth.back() == -1.0f);
        CHECK(int(bytes.back()) == 77);
    }
}

TEST_CASE("tone map: sRGB there and back", "[film]")
{
    for (int i = -2000; i <= 4000; ++i)
    {
        const float x = static_cast<float>(i) / 2000.0f;
        CHECK(linearFromSrgb(srgbFromLinear(x)) == Approx(x).margin(1e-6));
        CHECK(srgbFromLinear(linearFromSrgb(x)) == Approx(x).margin(1e-6));
    }
    CHECK(srgbFromLinear(0.5f) == Approx(0.7353569830524495));
    CHECK(linearFromSrgb(0.5f) == Approx(0.21404114048223255));
    CHECK(srgbFromLinear(0.0f) == 0.0f);
    CHECK(srgbFromLinear(1.0f) == Approx(1.0f));
}

TEST_CASE("resolve: display bytes are the rounded exact sRGB values, and monotonous", "[film]")
{
    // The values are all of [0,1] in steps of 1/65536: they may be off by half a grey level and
    // rounding.
    constexpr int kSize = 256;
    const Film film =
        filmOf(kSize, kSize, [](int x, int y) { return float(y * kSize + x) / 65536.0f; });
    std::vector<uint8_t> bytes(4 * kSize * kSize);
    for (int tile = 0; tile < film.tileCount(); ++tile)
        resolveTileDisplay(film, tile, ToneMap(), bytes.data(), nullptr);
    double worst = 0.0;
    for (std::size_t i = 0; i < kSize * kSize; ++i)
    {
        worst = std::max(worst, std::abs(bytes[4 * i] - 255.0 * exactSrgb(double(i) / 65536.0)));
        if (i > 0) REQUIRE(bytes[4 * i] >= bytes[4 * i - 4]);
    }
    CHECK(worst <= 0.5 + 0.003);
    CHECK(int(bytes[0]) == 0);
    CHECK(int(bytes[4 * (kSize * kSize - 1)]) == 255);
}

TEST_CASE("resolve: exposure is a power of two, also on display-referred films", "[film]")
{
    const Film film = filmOf(16, 16, [](int x, int) { return float(x) / 100.0f; });
    std::vector<uint8_t> bytes(4 * 256);
    ToneMap toneMap;
    toneMap.exposureEv = 2.0f;
    resolveTileDisplay(film, 0, toneMap, bytes.data(), nullptr);
    CHECK(std::abs(bytes[4 * 7] - 255.0 * exactSrgb(4.0 * 0.07)) <= 0.51);

    toneMap.displayReferred = true;
    resolveTileDisplay(film, 0, toneMap, bytes.data(), nullptr);
    const double linear = 4.0 * double(linearFromSrgb(0.07f));
    CHECK(std::abs(bytes[4 * 7] - 255.0 * exactSrgb(linear)) <= 0.51);
}

TEST_CASE("resolve: display-referred bytes at exposure 0 are the film's values", "[film]")
{
    const Film film = filmOf(16, 16, [](int x, int y) { return float(y * 16 + x) / 255.0f; });
    std::vector<uint8_t> bytes(4 * 256);
    ToneMap toneMap;
    toneMap.displayReferred = true;
    resolveTileDisplay(film, 0, toneMap, bytes.data(), nullptr);
    for (std::size_t i = 0; i < 256; ++i)
        REQUIRE(int(bytes[4 * i]) == int(i));
}

TEST_CASE("resolve: at edges the radiance is encoded, and multiplied with coverage", "[film]")
{
    // Radiance 0.4 covers a quarter of the pixel; in display-referred scenes the display value 0.4
    // covers it.
    Film film;
    film.reset(16, 16);
    TileRgba values;
    for (RgbaLanes& block : values)
    {
        for (int i = 0; i < kLanes; ++i)
        {
            block.r[i] = block.g[i] = block.b[i] = 0.25f * 0.4f;
            block.a[i] = 0.25f;
        }
    }
    film.beginPass();
    film.addPass(0, film.tilePasses(0), values);

    std::vector<uint8_t> bytes(4 * 256);
    ToneMap toneMap;
    toneMap.exposureEv = 1.0f;
    resolveTileDisplay(film, 0, toneMap, bytes.data(), nullptr);
    CHECK(std::abs(bytes[0] - 255.0 * 0.25 * exactSrgb(0.8)) <= 0.51);
    CHECK(int(bytes[3]) == 64);

    toneMap.displayReferred = true;
    resolveTileDisplay(film, 0, toneMap, bytes.data(), nullptr);
    CHECK(std::abs(bytes[0] - 255.0 * 0.25 * exactSrgb(2.0 * linearFromSrgb(0.4f))) <= 0.51);
    std::vector<float> radiance(4 * 256);
    resolveTileRadiance(film, 0, true, radiance.data());
    CHECK(radiance[0] == Approx(0.25f * linearFromSrgb(0.4f)));
}

TEST_CASE("resolve: a display-referred film's radiance is decoded", "[film]")
{
    const Film film = filmOf(16, 16, [](int x, int) { return float(x) / 50.0f; });
    std::vector<float> radiance(4 * 256);
    resolveTileRadiance(film, 0, true, radiance.data());
    CHECK(radiance[4 * 9] == linearFromSrgb(9.0f / 50.0f));
    CHECK(radiance[4 * 9 + 3] == 1.0f); // coverage is not a colour
}

TEST_CASE("resolve: NaN shows as 0, infinities and out-of-range values are clamped", "[film]")
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> values{nan, kInfinity, -kInfinity, -1.0f, 5.0f, 1e30f, 1e-30f, -0.0f};
    const std::vector<int> expected{0, 255, 0, 0, 255, 255, 0, 0};
    const Film film = filmOf(
        8, 1,
        [&](int x, int y) { return x < 8 && y == 0 ? values[static_cast<std::size_t>(x)] : 0.0f; });
    std::vector<uint8_t> bytes(4 * 8);
    for (const bool displayReferred : {false, true})
    {
        for (const float exposure : {0.0f, 1.0f, -1.0f})
        {
            CAPTURE(displayReferred, exposure);
            ToneMap toneMap;
            toneMap.displayReferred = displayReferred;
            toneMap.exposureEv = exposure;
            resolveTileDisplay(film, 0, toneMap, bytes.data(), nullptr);
            for (std::size_t i = 0; i < values.size(); ++i)
            {
                CAPTURE(i);
                CHECK(int(bytes[4 * i]) == expected[i]);
            }
        }
    }
}

TEST_CASE("resolve: the error channel is half the difference of the halves", "[film]")
{
    Film film;
    film.reset(5, 3);
    TileRgba tile = {};
    for (const float value : {1.0f, 4.0f})
    {
        tile[1].g[2] = value; // pixel (6, 0) is outside, (2, 0) is not
        tile[0].g[2] = value;
        film.beginPass();
        film.addPass(0, film.tilePasses(0), tile);
    }
    std::vector<float> error(3 * 5 * 3 + 1, -1.0f);
    resolveTileError(film, 0, false, error.data());
    CHECK(error[3 * 2 + 1] == 1.5f);
    CHECK(error[3 * 2] == 0.0f);
    CHECK(error[3 * 3 + 1] == 0.0f);
    CHECK(error.back() == -1.0f);
    resolveTileError(film, 0, true, error.data());
    CHECK(error[3 * 2 + 1] == Approx(0.5f * (linearFromSrgb(4.0f) - 1.0f)));
}

namespace
{

using Color = std::array<double, 3>;

/// Returns Khronos PBR Neutral of a colour, in double.
Color exactNeutral(Color c)
{
    const double low = std::min({c[0], c[1], c[2]});
    const double offset = low < 0.08 ? low - 6.25 * low * low : 0.04;
    for (double& value : c)
        value -= offset;
    const double peak = std::max({c[0], c[1], c[2]});
    if (peak < 0.76) return c;
    const double newPeak = 1.0 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
    const double grey = 1.0 - 1.0 / (0.15 * (peak - newPeak) + 1.0);
    for (double& value : c)
        value = value * newPeak / peak * (1.0 - grey) + newPeak * grey;
    return c;
}

/// Returns what a curve makes of a colour, as display bytes.
std::array<int, 4> shown(ToneCurve curve, const Color& color, float alpha = 1.0f, float ev = 0.0f)
{
    ToneMap toneMap;
    toneMap.curve = curve;
    toneMap.exposureEv = ev;
    const float pixel[4] = {float(color[0]) * alpha, float(color[1]) * alpha,
                            float(color[2]) * alpha, alpha};
    uint8_t bytes[4];
    displayPixels(pixel, 1, toneMap, bytes);
    return {bytes[0], bytes[1], bytes[2], bytes[3]};
}

} // namespace

TEST_CASE("tone curves: neutral is that of its specification", "[film]")
{
    for (const Color& color :
         {Color{0.0, 0.0, 0.0}, Color{0.03, 0.05, 0.04}, Color{0.18, 0.18, 0.18},
          Color{0.5, 0.2, 0.1}, Color{0.75, 0.9, 0.8}, Color{4.0, 1.0, 0.2}, Color{0.0, 0.0, 60.0},
          Color{900.0, 1000.0, 800.0}})
    {
        CAPTURE(color[0], color[1], color[2]);
        const Color expected = exactNeutral(color);
        const auto bytes = shown(ToneCurve::Neutral, color);
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(std::abs(bytes[i] - 255.0 * exactSrgb(std::max(expected[i], 0.0))) <= 0.52);
    }
}

TEST_CASE("tone curves: AgX keeps greys grey, grows, and ends at white", "[film]")
{
    int before = -1;
    for (double grey = 1e-4; grey < 1e4; grey *= 1.5)
    {
        CAPTURE(grey);
        const auto bytes = shown(ToneCurve::Agx, {grey, grey, grey});
        CHECK(std::abs(bytes[0] - bytes[1]) <= 1);
        CHECK(std::abs(bytes[0] - bytes[2]) <= 1);
        CHECK(bytes[0] >= before - 1);
        before = bytes[0];
    }
    CHECK(before >= 250);
    // The published fit at middle grey, worked out by hand: log2(0.18) is at 0.6061 of the range,
    // whose contrast is 0.4967, which a display of gamma 2.2 sends as 0.2145.
    CHECK(std::abs(shown(ToneCurve::Agx, {0.18, 0.18, 0.18})[0] - 255.0 * exactSrgb(0.2145)) <=
          1.0);
    const auto red = shown(ToneCurve::Agx, {50.0, 0.0, 0.0});
    CHECK(red[1] > 100); // bright red pales
}

TEST_CASE("tone curves: alpha and exposure act as without them, and nothing is not finite",
          "[film]")
{
    for (const ToneCurve curve : {ToneCurve::Srgb, ToneCurve::Neutral, ToneCurve::Agx})
    {
        const Color color{0.6, 0.3, 2.0};
        const auto whole = shown(curve, color), half = shown(curve, color, 0.5f);
        CHECK(half[3] == 128);
        for (std::size_t i = 0; i < 3; ++i)
            CHECK(std::abs(half[i] - whole[i] / 2.0) <= 1.0);
        CHECK(shown(curve, {0.3, 0.15, 1.0}, 1.0f, 1.0f) == whole);
        const double inf = std::numeric_limits<double>::infinity();
        CHECK(shown(curve, {inf, inf, inf})[0] >= 250);
        CHECK(shown(curve, {std::nan(""), -1.0, 0.0})[1] <= 1);
    }
}
