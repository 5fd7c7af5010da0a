// TileLookupsTest.cpp - the light of discs that were wrong leaves the image again.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/photons/RadiusSchedule.h"
#include "osgRayTrace/session/FirstPasses.h"
#include "osgRayTrace/session/TileLookups.h"

#include <algorithm>
#include <memory>

using namespace osgRayTrace::engine;

namespace
{

constexpr float kDisc = 3.0f, kFootprint = 1.0f; ///< light of the look-ups
constexpr std::size_t kPixel = 37;
constexpr float kAlpha = 2.0f / 3.0f;

std::unique_ptr<GatheredPhotons> gatheredIn(int pass)
{
    auto gathered = std::make_unique<GatheredPhotons>();
    gathered->wantsFirstHits = TileLookups::repays(pass);
    return gathered;
}

/// Lets the pixel change over, and its neighbours with it, whose discs are clearly wrong.
void changeOver(TileLookups& lookups)
{
    for (const std::size_t pixel : {kPixel - 1, kPixel, kPixel + 1}) // they are side by side
    {
        lookups.planes[pixel].lookup = PixelLookup::Footprint;
        lookups.planes[pixel].difference = 10.0f;
        lookups.planes[pixel].squares = 1.0f;
    }
}

/// Sums up passes of a pixel that changes over at some pass, half by half.
struct Pixel
{
    explicit Pixel(int passOfChange, float disc = kDisc) : change(passOfChange), discLight(disc) {}

    void add(int pass)
    {
        const auto gathered = gatheredIn(pass);
        const float light = pass < change ? discLight : kFootprint;
        gathered->atFirstHits[kPixel] = Vec3(light);
        if (pass + 1 >= change) changeOver(*lookups);
        TileRgba rgba = {};
        rgba[kPixel / kLanes].g[kPixel % kLanes] = light;
        lookups->finish(pass, 1, kAlpha, *gathered, rgba);
        sums[pass & 1] += double(rgba[kPixel / kLanes].g[kPixel % kLanes]);
    }

    int change;
    float discLight;
    std::unique_ptr<TileLookups> lookups = std::make_unique<TileLookups>();
    double sums[2] = {};
};

} // namespace

TEST_CASE("tile lookups: nothing is left of discs that were wrong, in either half", "[session]")
{
    for (int change = 1; change <= kChoosingPasses; ++change)
    {
        Pixel wrong(change), right(change, kFootprint);
        for (int pass = 0; pass < 64; ++pass)
        {
            wrong.add(pass);
            right.add(pass);
            const int passes = pass + 1;
            CAPTURE(change, passes);
            // The weights of passes are their number all the time.
            CHECK(right.sums[0] + right.sums[1] == Approx(passes * kFootprint).epsilon(1e-5));
            if (passes < change) continue;
            const double share = wrong.lookups->discShare(kPixel, passes);
            const double mean = (wrong.sums[0] + wrong.sums[1]) / passes;
            CHECK(mean == Approx(share * kDisc + (1.0 - share) * kFootprint).epsilon(1e-5));
            CHECK(share <= std::min(1.0, double(change) / passes));
            if (TileLookups::repays(passes)) continue;
            CHECK(share == 0.0);
            for (int half = 0; half < 2; ++half)
                CHECK(wrong.sums[half] ==
                      Approx((passes + 1 - half) / 2 * kFootprint).epsilon(1e-5));
        }
    }
}

TEST_CASE("tile lookups: nothing is left of passes that others replace, nor of wrong discs beside",
          "[session]")
{
    for (const int before : {2, 1000}) // a pixel that had changed over, and one that had not
        for (int change = FirstPasses::kCount + 1; change <= kChoosingPasses; ++change)
        {
            FirstPasses first;
            first.reset(1);
            auto lookups = std::make_unique<TileLookups>();
            double sums[2] = {};
            for (int pass = 0; pass < 64; ++pass)
            {
                const bool isFirst = pass < FirstPasses::kCount;
                if (pass == FirstPasses::kCount) lookups->restart();
                const int changes = isFirst ? before : change;
                const auto gathered = gatheredIn(pass);
                // Light of discs differs from pass to pass, that of the first passes the most.
                const float disc = isFirst ? 100.0f * float(1 + pass % 3) : kDisc + float(pass % 3);
                const float light = pass < changes ? disc : kFootprint;
                gathered->atFirstHits[kPixel] = Vec3(light);
                if (pass + 1 >= changes) changeOver(*lookups);
                TileRgba rgba = {};
                rgba[kPixel / kLanes].g[kPixel % kLanes] = light;
                const int counted = first.replace(0, pass, rgba);
                lookups->finish(pass, counted, kAlpha, *gathered, rgba);
                if (isFirst) first.add(0, pass, rgba);
                sums[pass & 1] += double(rgba[kPixel / kLanes].g[kPixel % kLanes]);
            }
            CAPTURE(before, change);
            for (const double sum : sums)
                CHECK(sum == Approx(32.0 * kFootprint).epsilon(1e-4));
            CHECK(lookups->discShare(kPixel, 64) == 0.0);
        }
}

TEST_CASE(
    "tile lookups: a pixel that changes over alone keeps the light of its discs but for caustics",
    "[session]")
{
    const bool causticsAlone = GENERATE(false, true);
    TileLookups lookups(causticsAlone);
    double sum = 0.0;
    for (int pass = 0; pass < 64; ++pass)
    {
        const auto gathered = gatheredIn(pass);
        const float light = pass < 5 ? kDisc : kFootprint;
        gathered->atFirstHits[kPixel] = Vec3(light);
        if (pass == 4)
        {
            changeOver(lookups);
            lookups.planes[kPixel + 1] = lookups.planes[kPixel - 1] = SeenPlane();
        }
        TileRgba rgba = {};
        rgba[kPixel / kLanes].g[kPixel % kLanes] = light;
        lookups.finish(pass, 1, kAlpha, *gathered, rgba);
        sum += double(rgba[kPixel / kLanes].g[kPixel % kLanes]);
    }
    const double left = causticsAlone ? 0.0 : 5.0;
    CHECK(sum == Approx(left * kDisc + (64.0 - left) * kFootprint).epsilon(1e-5));
    CHECK(lookups.discShare(kPixel, 64) == Approx(left / 64.0));
}

TEST_CASE("tile lookups: a pixel whose footprint is dark is never below black", "[session]")
{
    for (const float disc : {1e-6f, 0.3f, 1e6f})
    {
        Pixel pixel(11, disc);
        double sums[2] = {};
        for (int pass = 0; pass < 64; ++pass)
        {
            const auto gathered = gatheredIn(pass);
            const float light = pass < pixel.change ? disc * float(1 + pass % 3) : 0.0f;
            gathered->atFirstHits[kPixel] = Vec3(light);
            if (pass + 1 >= pixel.change) changeOver(*pixel.lookups);
            TileRgba rgba = {};
            rgba[kPixel / kLanes].g[kPixel % kLanes] = light;
            pixel.lookups->finish(pass, 1, kAlpha, *gathered, rgba);
            sums[pass & 1] += double(rgba[kPixel / kLanes].g[kPixel % kLanes]);
            CHECK(sums[pass & 1] >= 0.0);
        }
        CHECK(sums[0] + sums[1] < 1e-4 * double(disc));
    }
}

TEST_CASE("tile lookups: a pixel that sees another plane in the end keeps what it has", "[session]")
{
    Pixel pixel(6, kFootprint);
    for (int pass = 0; pass < 9; ++pass)
        pixel.add(pass);
    pixel.change = 1000; // discs from now on
    pixel.lookups->planes[kPixel].lookup = PixelLookup::Disc;
    for (int pass = 9; pass < 64; ++pass)
    {
        const auto gathered = gatheredIn(pass);
        gathered->atFirstHits[kPixel] = Vec3(kFootprint);
        TileRgba rgba = {};
        rgba[kPixel / kLanes].g[kPixel % kLanes] = kFootprint;
        pixel.lookups->finish(pass, 1, kAlpha, *gathered, rgba);
        CHECK(rgba[kPixel / kLanes].g[kPixel % kLanes] == kFootprint);
    }
}

TEST_CASE("tile lookups: light that leaks in a colour is taken from pixels of that colour",
          "[session]")
{
    auto lookups = std::make_unique<TileLookups>();
    constexpr std::size_t kRed = 3, kGreen = 90;
    for (std::size_t p = 128; p < 192; ++p)
        lookups->planes[p].lookup = PixelLookup::Footprint; // so discs leak
    for (const std::size_t p : {kRed, kGreen})
        lookups->planes[p].lookup = PixelLookup::Compared;
    for (int pass = 0; pass < 60; ++pass)
    {
        const auto gathered = gatheredIn(pass);
        gathered->atFirstHits[kRed] = Vec3(2.0f, 0.0f, 0.0f);
        gathered->atFirstHits[kGreen] = Vec3(0.0f, 1.0f, 0.0f);
        gathered->balances = lookups->balances(pass);
        REQUIRE(gathered->balances == (pass >= kChoosingPasses));
        gathered->leaked = Vec3(0.0f, 0.5f, 0.25f); // no pixel has blue light
        TileRgba rgba = {};
        lookups->finish(pass, 1, kAlpha, *gathered, rgba);
        const auto lightOf = [&](std::size_t p)
        {
            const RgbaLanes& block = rgba[p / kLanes];
            const std::size_t lane = p % kLanes;
            return Vec3(block.r[lane], block.g[lane], block.b[lane]);
        };
        CAPTURE(pass);
        CHECK(lightOf(kRed) == Vec3(0.0f));
        CHECK(lightOf(kGreen).x == 0.0f);
        CHECK(lightOf(kGreen).z == 0.0f);
        if (pass < kChoosingPasses) continue;
        if (TileLookups::repays(pass))
            CHECK(lightOf(kGreen).y < -0.5f);
        else
            CHECK(lightOf(kGreen).y == Approx(-0.5f));
    }
}

TEST_CASE("tile lookups: what leaked in the first passes is that of their radii", "[session]")
{
    // Discs leak with the square of their radii, in passes that count as often as `counted` says.
    const auto leftOf = [](float alpha, bool restarts)
    {
        const auto lookups = std::make_unique<TileLookups>();
        for (std::size_t p = 128; p < 192; ++p)
            lookups->planes[p].lookup = PixelLookup::Footprint; // so discs leak
        double sum = 0.0;
        for (int pass = restarts ? FirstPasses::kCount : 0; pass < 48; ++pass)
        {
            const int counted = restarts && pass < 2 * FirstPasses::kCount ? 2 : 1;
            const auto gathered = gatheredIn(pass);
            gathered->shrink2 = float(globalRadiusSquared(pass, double(alpha)));
            gathered->smoothShrink2 =
                lookups->shrinksLate(pass)
                    ? float(globalRadiusSquared(pass, double(alpha), kLatePasses))
                    : gathered->shrink2;
            const float leak = gathered->shrink2Of(lookups->planes[kPixel]);
            lookups->planes[kPixel].lookup = PixelLookup::Compared; // from the first pass on
            gathered->atFirstHits[kPixel] = Vec3(leak);
            gathered->balances = lookups->balances(pass);
            gathered->leaked = Vec3(leak);
            TileRgba rgba = {};
            rgba[kPixel / kLanes].g[kPixel % kLanes] = leak * float(counted);
            lookups->finish(pass, counted, alpha, *gathered, rgba);
            sum += double(rgba[kPixel / kLanes].g[kPixel % kLanes]);
        }
        return sum;
    };
    for (const float alpha : {0.4f, kAlpha, 1.0f})
        for (const bool restarts : {false, true})
        {
            CAPTURE(alpha, restarts);
            CHECK(leftOf(alpha, restarts) == Approx(0.0).margin(1e-4));
        }
}

/// Returns the mean of the radii of so many passes.
double meanRadius(int passes, int late)
{
    double sum = 0.0;
    for (int pass = 0; pass < passes; ++pass)
        sum += std::sqrt(globalRadiusSquared(pass, double(kAlpha), late));
    return sum / passes;
}

TEST_CASE("tile lookups: bias of discs counts as often as the passes that have it", "[session]")
{
    const bool isSmooth = GENERATE(false, true);
    const double difference = isSmooth ? 3.0 : 6.0; // standard error: 2.2
    const int late = isSmooth ? kLatePasses : 0;
    for (const bool restarts : {false, true})
    {
        const auto lookups = std::make_unique<TileLookups>();
        const int first = restarts ? FirstPasses::kCount : 0;
        SeenPlane& known = lookups->planes[kPixel];
        known.lookup = PixelLookup::Compared;
        known.difference = float(difference);
        known.squares = 5.0f;
        for (int pass = first; pass < kChoosingPasses; ++pass)
        {
            const int counted = restarts && pass < 2 * FirstPasses::kCount ? 2 : 1;
            TileRgba rgba = {};
            lookups->finish(pass, counted, kAlpha, *gatheredIn(pass), rgba);
            ++(pass < 8 ? known.undecided : known.compared);
        }
        for (const int passes : {kChoosingPasses, 4 * kChoosingPasses})
        {
            FootprintBias compared, discs, expected, later;
            lookups->addBiases(passes, compared, discs);
            const double choosing = double(kChoosingPasses) / passes;
            expected.addPixel(8, difference, 5.0, choosing);
            CAPTURE(isSmooth, restarts, passes);
            CHECK(compared.squares == Approx(expected.squares));
            // Bias goes with the radius: that of all passes is that of both parts together.
            const double all = meanRadius(passes, late) / meanRadius(kChoosingPasses, late);
            later.addPixel(8, difference, 5.0, std::sqrt(all * all - choosing * choosing));
            CHECK(discs.squares == Approx(later.squares).epsilon(0.07).margin(1e-6));
        }
    }
}

TEST_CASE("tile lookups: what discs without footprints blur leaves the image unless it is noise",
          "[session]")
{
    const float noise = GENERATE(0.02f, 0.5f); // of the light, with either sign
    const float blur = GENERATE(0.1f, -0.1f, 1.2f);
    constexpr float kLight = 4.0f;
    const bool isTaken = noise < 0.1f && blur < 1.0f; // more than a quarter is no smooth light
    TileLookups lookups;
    double left[2] = {}; // of blur, in each half
    for (int pass = 0; pass < 64; ++pass)
    {
        const auto gathered = gatheredIn(pass);
        lookups.beginBlur(pass, *gathered);
        CAPTURE(noise, blur, pass);
        REQUIRE(gathered->wantsBlur == (pass < kChoosingPasses || isTaken));
        REQUIRE(gathered->takesBlur == (pass >= kChoosingPasses && isTaken));
        const float sign = pass / 2 % 2 ? -1.0f : 1.0f;
        gathered->blurred = Vec3(kLight);
        gathered->blur = Vec3(blur + sign * noise * kLight);
        left[pass & 1] += double(blur);
        if (gathered->takesBlur)
            left[pass & 1] -= double(blur) + double(gathered->earlierBlur.y * kLight);
        TileRgba rgba = {};
        lookups.finish(pass, 1, kAlpha, *gathered, rgba);
    }
    for (const double half : left)
        CHECK(half == Approx(isTaken ? 0.0 : 32.0 * double(blur)).margin(1e-5));
}

TEST_CASE("tile lookups: discs shrink late until they are seen beside a caustic", "[session]")
{
    for (const bool causticsAlone : {false, true})
        for (const std::size_t changed : {0u, 8u, 64u}) // pixels of the tile's 256
        {
            TileLookups lookups(causticsAlone);
            for (std::size_t p = 0; p < kTilePixels; ++p)
                lookups.planes[p].lookup =
                    p < changed ? PixelLookup::Footprint : PixelLookup::Compared;
            for (int pass = 0; pass < 100; ++pass)
            {
                const bool isLate = pass < kChoosingPasses || changed < 16;
                CAPTURE(causticsAlone, changed, pass);
                CHECK(lookups.shrinksLate(pass) == (isLate && !causticsAlone));
                const auto gathered = gatheredIn(pass);
                gathered->atFirstHits[kTilePixels - 1] = Vec3(1.0f);
                TileRgba rgba = {};
                lookups.finish(pass, 1, kAlpha, *gathered, rgba);
            }
        }
}

TEST_CASE("tile lookups: discs that end at an edge do not shrink late", "[session]")
{
    GatheredPhotons gathered;
    gathered.shrink2 = 0.25f;
    gathered.smoothShrink2 = 0.75f;
    SeenPlane pixel;
    pixel.lookup = PixelLookup::Compared;
    for (const DiscEdge edge :
         {DiscEdge::Unknown, DiscEdge::None, DiscEdge::Straight, DiscEdge::Near})
    {
        pixel.edge = edge;
        const bool ends = edge == DiscEdge::Straight || edge == DiscEdge::Near;
        CHECK(gathered.shrink2Of(pixel) == (ends ? 0.25f : 0.75f));
    }
}

TEST_CASE("tile lookups: discs are given up once they are as small as footprints", "[session]")
{
    const TileLookups lookups;
    SeenPlane pixel;
    pixel.lookup = PixelLookup::Compared;
    pixel.discPixels = 2.0f;
    pixel.squares = 4.0f;
    const bool isSmooth = GENERATE(false, true);
    int first = 0;
    for (int pass = 0; pass < 1024; ++pass)
    {
        GatheredPhotons gathered;
        gathered.smallDisc = lookups.smallDisc(pass);
        gathered.shrink2 = float(globalRadiusSquared(pass, double(kAlpha)));
        gathered.smoothShrink2 = float(globalRadiusSquared(pass, double(kAlpha), kLatePasses));
        pixel.difference = isSmooth ? 2.9f : 3.1f; // of a standard error of 2
        const double area =
            2.0 * globalRadiusSquared(pass, double(kAlpha), isSmooth ? kLatePasses : 0);
        CAPTURE(pass);
        CHECK(gathered.isSmall(pixel) == (area < 1.0 && !TileLookups::repays(pass)));
        if (!first && gathered.isSmall(pixel)) first = pass;
    }
    CHECK(first == (isSmooth ? 234 : 48));
    GatheredPhotons gathered;
    gathered.smallDisc = 100.0f;
    pixel.lookup = PixelLookup::Disc;
    CHECK(!gathered.isSmall(pixel));
    pixel.lookup = PixelLookup::Compared;
    pixel.discPixels = 0.0f; // not known
    CHECK(!gathered.isSmall(pixel));
}
