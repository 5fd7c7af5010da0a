// TileLookups.cpp - takes light of discs that were wrong out of the image again. Layer: session.
// SPDX-License-Identifier: MIT
//
// A pixel that changes over to its footprint at pass c has c_h passes of each half h of the film by
// discs, whose light is D_h. From pass kChoosingPasses on, each of the next kRepayingPasses c_h = n
// passes of that half, whose footprints have the light F, adds
//
//   F + (c_h F - D_h) / n
//
// in place of F. The weights of all passes add up to their number at any time, and after these
// passes nothing of D_h is left. The halves stay independent of each other. A pass that takes the
// place of another one counts twice in c_h and D_h, and that other one does not count.
//
// If all pixels took discs, these would spread light among pixels, but lose none of it. Once the
// pixels on a sharp caustic have changed over, they show all of their light, and discs beside them
// show a part of it again. So the discs of a tile's pixels may have no more light together than the
// photons in these pixels' footprints: in each pass the rest,
//
//   leaked = sum over pixels with discs of (D - F),
//
// is taken from these pixels, from each as much as its share of their light by discs in the first
// passes. Each colour channel has shares of its own: green light that leaks leaves red pixels
// alone. These shares do not depend on the pass, so the tile's light has no bias. The sum has
// little noise, as most photons are in it on both sides.
//
// Discs behind mirrors and glass have no footprints. They make smooth light brighter or darker by
// what discs of half the radius tell: measureBlur in PathPhotons.cpp. Summed over the tile that has
// little noise, too, for most photons are in as many discs as half discs. So each pass b of these
// discs' light D, for the tile as a whole, leaves every pixel's light by such discs: each of it
// becomes (1 - b / D) of itself. What the first kChoosingPasses have too much, b_h of D_h in a
// half, is taken by the passes that make up for them, as b_h / D_h / kRepayingPasses more.
#include "osgRayTrace/session/TileLookups.h"

#include "osgRayTrace/photons/RadiusSchedule.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// What is left of a disc's light in the end is 0 but for rounding, and never less.
constexpr float kRoundedDown = 1.0f - 0x1p-19f;

/// A pixel that has not found its disc wrong takes its footprint all the same if so many of its
/// eight neighbours do, and if the nine have seen a squared bias of so many standard errors: its
/// disc reaches into them, and they have not changed over by chance.
constexpr int kChangedNeighbours = 3;
constexpr float kNeighbourSignificance = 2.0f;

/// The blur of discs without footprints stays in the image if it changes from pass to pass by more
/// than this share of their light, as the root of its mean square. A disc's own noise is a quarter
/// of its light in the first passes, and more later on.
constexpr float kNoisyBlur = 0.08f;

/// The blur of such discs stays, too, if it is a larger share of their light in a colour channel of
/// a half: that is no blur of smooth light, but a caustic beside or in the tile, and what it adds
/// is not spread as the light is.
constexpr float kLargestBlur = 0.25f;

/// Discs that are no larger than so many footprints are given up, in tiles whose discs leak and in
/// others. As large as one, they have the noise of the footprint, and blur besides.
constexpr float kSmallBesideCaustics = 3.0f, kSmallElsewhere = 1.0f;

/// Discs leak if one of so many of the tile's pixels has changed over.
constexpr int kLeakingShare = 16;

/// Returns how many of the first passes belong to a half.
int passesOfHalf(int passes, int half)
{
    return (passes + 1 - half) / 2;
}

/// What a pixel knows of its discs, or sums over some pixels. The products of the differences of
/// two passes have the squared bias as their mean: FootprintBias::addPixel.
struct Neighbour
{
    int changed = 0;
    float products = 0.0f; ///< sum of the products
    float variance = 0.0f; ///< variance of products if there is no bias

    void add(const Neighbour& other)
    {
        changed += other.changed;
        products += other.products;
        variance += other.variance;
    }
    bool areWrong() const
    {
        return changed >= kChangedNeighbours &&
               products > kNeighbourSignificance * std::sqrt(variance);
    }
};

Neighbour neighbourOf(const SeenPlane& pixel)
{
    return {pixel.lookup == PixelLookup::Footprint,
            pixel.difference * pixel.difference - pixel.squares,
            2.0f * pixel.squares * pixel.squares};
}

void addLight(std::size_t pixel, Vec3 light, RgbaLanes* rgba)
{
    RgbaLanes& block = rgba[pixel / kLanes];
    block.r[pixel % kLanes] += light.x;
    block.g[pixel % kLanes] += light.y;
    block.b[pixel % kLanes] += light.z;
}

} // namespace

void TileLookups::restart()
{
    if (_hasRestarted) return;
    *this = TileLookups(_forgetsAlone);
    _hasRestarted = true;
}

void TileLookups::finish(int pass, int counted, float alpha, const GatheredPhotons& gathered,
                         RgbaLanes* rgba)
{
    _alpha = alpha;
    if (pass < kChoosingPasses) _counted[pass] = static_cast<uint8_t>(counted);
    if (gathered.wantsBlur && pass < kChoosingPasses) addBlur(pass, gathered);
    if (gathered.wantsFirstHits) forgetDiscs(pass, gathered, rgba);
    if (pass < kChoosingPasses) addDiscAreas(counted, gathered);
    if (pass + 1 == kChoosingPasses)
    {
        endChoosing();
        _earlierLeak = earlierLeak(static_cast<double>(alpha));
    }
    if (gathered.balances) takeLeaked(pass, gathered, rgba);
}

void TileLookups::addBlur(int pass, const GatheredPhotons& gathered)
{
    const auto counted = static_cast<float>(_counted[pass]);
    _blur[pass & 1] += gathered.blur * counted;
    _blurred[pass & 1] += gathered.blurred * counted;
    const float blur = luminance(gathered.blur);
    _blurLight += luminance(gathered.blurred);
    _blurSum += blur;
    _blurSquares += blur * blur;
    ++_blurPasses;
}

bool TileLookups::takesBlur() const
{
    if (_blurPasses < 2 || !(_blurLight > 0.0f)) return false;
    for (int half = 0; half < 2; ++half)
        for (int c = 0; c < 3; ++c)
            if (std::fabs(_blur[half][c]) > kLargestBlur * _blurred[half][c]) return false;
    const auto passes = static_cast<float>(_blurPasses);
    const float mean = _blurSum / passes, variance = _blurSquares / passes - mean * mean;
    return std::sqrt(std::max(variance, 0.0f)) < kNoisyBlur * _blurLight / passes;
}

void TileLookups::beginBlur(int pass, GatheredPhotons& gathered) const
{
    gathered.wantsBlur = pass < kChoosingPasses || takesBlur();
    gathered.takesBlur = gathered.wantsBlur && pass >= kChoosingPasses;
    if (!gathered.takesBlur || !repays(pass)) return;
    const int half = pass & 1;
    for (int c = 0; c < 3; ++c)
        if (_blurred[half][c] > 0.0f)
            gathered.earlierBlur[c] = _blur[half][c] / _blurred[half][c] / kRepayingPasses;
}

// Passes that make up for others count the discs of pixels that compare, so these change none.
float TileLookups::smallDisc(int pass) const
{
    if (repays(pass)) return 0.0f;
    return _leaks ? kSmallBesideCaustics : kSmallElsewhere;
}

void TileLookups::addDiscAreas(int counted, const GatheredPhotons& gathered)
{
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        const float area = _wasSmooth[p] ? gathered.smoothShrink2 : gathered.shrink2;
        _discAreas[p] += area * static_cast<float>(counted);
        _wasSmooth[p] = planes[p].isSmooth();
    }
}

void TileLookups::forgetDiscs(int pass, const GatheredPhotons& gathered, RgbaLanes* rgba)
{
    const int half = pass & 1;
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        const bool takesFootprint = planes[p].lookup == PixelLookup::Footprint;
        if (pass < kChoosingPasses)
        {
            if (_changes[p] != 0) continue;
            _discs[half][p] += gathered.atFirstHits[p] * static_cast<float>(_counted[pass]);
            if (takesFootprint) _changes[p] = static_cast<uint8_t>(pass + 1);
            continue;
        }
        if (!takesFootprint || !_forgets[p]) continue;
        const int wrong = countedOf(p, half);
        if (pass / 2 >= kChoosingPasses / 2 + wrong * kRepayingPasses) continue;
        const Vec3 disc = _discs[half][p] * (kRoundedDown / static_cast<float>(wrong));
        addLight(p, (gathered.atFirstHits[p] - disc) * (1.0f / kRepayingPasses), rgba);
    }
}

/// Changes pixels over among others that have changed, and tells whether the rest leaks.
void TileLookups::endChoosing()
{
    Neighbour pixels[kTileSize + 2][kTileSize + 2] = {}; // with a margin
    const auto placeOf = [&](std::size_t p)
    {
        const int block = static_cast<int>(p) / kLanes, lane = static_cast<int>(p) % kLanes;
        return &pixels[laneY(block, lane) + 1][laneX(block, lane) + 1];
    };
    for (std::size_t p = 0; p < kTilePixels; ++p)
        *placeOf(p) = neighbourOf(planes[p]);
    int count = 0;
    Vec3 light(0.0f);
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        const Neighbour* const place = placeOf(p);
        Neighbour sum;
        for (const Neighbour* row : {place - (kTileSize + 2), place, place + (kTileSize + 2)})
            for (int k = -1; k <= 1; ++k)
                sum.add(row[k]);
        _forgets[p] = _forgetsAlone || sum.areWrong();
        if (planes[p].lookup == PixelLookup::Compared && sum.areWrong())
        {
            planes[p].lookup = PixelLookup::Footprint;
            _changes[p] = kChoosingPasses;
        }
        count += planes[p].lookup == PixelLookup::Footprint;
        if (planes[p].lookup == PixelLookup::Compared) light += _discs[0][p] + _discs[1][p];
    }
    _leaks = count * kLeakingShare >= kTilePixels && isFinite(light) && luminance(light) > 0.0f;
}

/// Returns what leaks in the mean of the first kChoosingPasses, by how often they count, over what
/// leaks in the mean of the passes that make up for them. Blur of smooth light goes with the square
/// of the radius [Knaus11]. Each pixel's blur counts by what it has seen of it.
float TileLookups::earlierLeak(double alpha) const
{
    int counted = 0;
    double later = 0.0;
    for (int pass = 0; repays(pass); ++pass)
        if (pass < kChoosingPasses)
            counted += _counted[pass];
        else
            later += globalRadiusSquared(pass, alpha) / (kChoosingPasses * kRepayingPasses);
    double leaked = 0.0, perArea = 0.0; // in the first passes; by a disc as large as the first one
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        if (planes[p].lookup != PixelLookup::Compared) continue;
        const auto seen = static_cast<double>(std::fabs(planes[p].difference) + FLT_MIN);
        leaked += seen;
        perArea += seen * counted / static_cast<double>(_discAreas[p]);
    }
    return perArea > 0.0 ? static_cast<float>(leaked / perArea / later) : 0.0f;
}

void TileLookups::takeLeaked(int pass, const GatheredPhotons& gathered, RgbaLanes* rgba) const
{
    const auto takesDisc = [&](std::size_t p)
    { return planes[p].lookup == PixelLookup::Compared && !gathered.isSmall(planes[p]); };
    Vec3 light(0.0f);
    for (std::size_t p = 0; p < kTilePixels; ++p)
        if (takesDisc(p)) light += _discs[0][p] + _discs[1][p];
    const float passes = repays(pass) ? 1.0f + _earlierLeak / kRepayingPasses : 1.0f;
    Vec3 perLight(0.0f); // of a pixel's light by discs; 0 in channels without any
    for (int c = 0; c < 3; ++c)
        if (light[c] > 0.0f) perLight[c] = -passes * gathered.leaked[c] / light[c];
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        if (!takesDisc(p)) continue;
        addLight(p, perLight * (_discs[0][p] + _discs[1][p]), rgba);
    }
}

// Whether a pixel has changed over hangs on its differences, so those of all pixels count: only
// their sum has no bias. Pixels that still take discs are biased in later passes, too. Bias is
// taken to go with the radius, between its square for smooth light and its root at a fold caustic.
void TileLookups::addBiases(int passes, FootprintBias& compared, FootprintBias& discs) const
{
    int counted = 0; // of the passes that may choose, which are discs where no pixel has changed
    for (int pass = 0; pass < std::min(passes, kChoosingPasses); ++pass)
        counted += _counted[pass];
    const double chose = std::min(1.0, static_cast<double>(counted) / passes);
    const LaterDiscs rough = laterDiscs(passes, false), smooth = laterDiscs(passes, true);
    for (std::size_t p = 0; p < kTilePixels; ++p)
    {
        const SeenPlane& known = planes[p];
        if (known.compared == 0) continue;
        const bool changed = known.lookup == PixelLookup::Footprint;
        const double sum = static_cast<double>(known.difference);
        const double squares = static_cast<double>(known.squares);
        compared.addPixel(known.compared, sum, squares, changed ? discShare(p, passes) : chose);
        if (changed) continue;
        const LaterDiscs& later = known.isSmooth() ? smooth : rough;
        discs.addPixel(known.compared, sum, squares, later.share * discsUntil(p, passes, later));
    }
}

TileLookups::LaterDiscs TileLookups::laterDiscs(int passes, bool isSmooth) const
{
    const int choosing = std::min(passes, kChoosingPasses);
    const double first = static_cast<double>(choosing) / passes;
    const double all = first * sumOfRadii(passes, isSmooth) / sumOfRadii(choosing, isSmooth);
    LaterDiscs later;
    later.share = std::sqrt(std::max(0.0, all * all - first * first));
    later.late = isSmooth && shrinksLate(passes) ? kLatePasses : 0;
    later.shrink2 = globalRadiusSquared(passes, static_cast<double>(_alpha), later.late);
    return later;
}

/// Returns the sum of the radii of a pixel that compares over so many passes from the first one on,
/// in first radii. Those of pass n go with (n + late)^((alpha - 1) / 2) [Knaus11].
double TileLookups::sumOfRadii(int passes, bool isSmooth) const
{
    const double power = 0.5 + 0.5 * static_cast<double>(_alpha);
    const auto sum = [&](int count, double late)
    {
        const double scale = std::pow(std::max(1.0, late), 1.0 - power) / power;
        return scale * (std::pow(count + late, power) - std::pow(late, power));
    };
    if (!isSmooth || !shrinksLate(0)) return sum(passes, 0.0);
    if (shrinksLate(passes)) return sum(passes, kLatePasses);
    return sum(kChoosingPasses, kLatePasses) + sum(passes, 0.0) - sum(kChoosingPasses, 0.0);
}

/// Returns the sum of the radii of the later passes in which the pixel, which still compares, looks
/// up discs, over that of all later passes.
double TileLookups::discsUntil(std::size_t pixel, int passes, const LaterDiscs& later) const
{
    const double disc = static_cast<double>(planes[pixel].discPixels) * later.shrink2;
    const auto small = static_cast<double>(smallDisc(passes));
    if (!(disc > 0.0 && disc < small)) return 1.0;
    const bool isSmooth = planes[pixel].isSmooth();
    const auto alpha = static_cast<double>(_alpha);
    const double share = alpha < 1.0 ? std::pow(disc / small, 1.0 / (1.0 - alpha)) : 0.0;
    const int first = kChoosingPasses * (1 + kRepayingPasses);
    const int last = std::max(first, static_cast<int>(share * (passes + later.late)) - later.late);
    return sumOfRadii(std::min(last, passes), isSmooth) / sumOfRadii(passes, isSmooth);
}

/// Returns how often the passes of a half count in which the pixel looked up discs before it
/// changed over.
int TileLookups::countedOf(std::size_t pixel, int half) const
{
    int counted = 0;
    for (int pass = half; pass < _changes[pixel]; pass += 2)
        counted += _counted[pass];
    return counted;
}

double TileLookups::discShare(std::size_t pixel, int passes) const
{
    double left = 0.0;
    for (int half = 0; half < 2; ++half)
    {
        const int wrong = countedOf(pixel, half);
        const int later = std::max(0, passesOfHalf(passes, half) - kChoosingPasses / 2);
        const int repaid = _forgets[pixel] ? later : 0;
        left += std::max(0.0, wrong - static_cast<double>(repaid) / kRepayingPasses);
    }
    return std::min(1.0, left / passes);
}

} // namespace osgRayTrace::engine
