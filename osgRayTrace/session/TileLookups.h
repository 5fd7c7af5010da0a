// TileLookups.h - how the pixels of a tile have looked up photons so far. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/KernelBias.h"
#include "osgRayTrace/integrators/shared/TileResult.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Passes in which pixels may choose between discs and footprints: later ones cannot depend on how
/// many passes another machine has made.
constexpr int kChoosingPasses = 16;

/// The passes that make up for one by a disc that was wrong. Fewer make the image right sooner,
/// more have less noise.
constexpr int kRepayingPasses = 2;

/// Discs in smooth light shrink as if so many passes had come before the first one: they have noise
/// and little else. With more there is hardly less noise in 64 passes, and more blur in a thousand.
constexpr int kLatePasses = 32;

/// What the pixels of a tile see, and the light of the discs that they have looked up. A pixel that
/// takes the photons of its footprint from some pass on has found its discs wrong, so their light
/// is taken out of the image again, and later passes count more in its place. Pixels that keep
/// their discs keep the light of their own photons, too: discs beside a sharp caustic have light of
/// pixels that have all of that light themselves. All corrections of a pass depend on the first
/// kChoosingPasses and on that pass alone, so passes may be made in any order and by several
/// machines. One thread at a time.
class TileLookups
{
public:
    /// causticsAlone: photons bring caustics only. Then single pixels forget their discs, too.
    explicit TileLookups(bool causticsAlone = false) : _forgetsAlone(causticsAlone) {}

    SeenPlane planes[kTilePixels];

    /// Whether some pass from pass number `pass` on may still make up for discs that were wrong.
    static bool repays(int pass) { return pass < kChoosingPasses * (1 + kRepayingPasses); }

    /// Whether pixels with discs are to find their own photons in a pass:
    /// GatheredPhotons::balances.
    bool balances(int pass) const { return pass >= kChoosingPasses && _leaks; }

    /// Whether discs in smooth light shrink late, by kLatePasses, in a pass. They do not where
    /// photons bring caustics only, or, once all pixels have chosen, beside a caustic.
    bool shrinksLate(int pass) const
    {
        return !_forgetsAlone && (pass < kChoosingPasses || !_leaks);
    }

    /// Forgets all passes so far, which leave the image: see FirstPasses. Does so only once.
    void restart();

    /// Sets what a pass is to do about the blur of discs without footprints.
    void beginBlur(int pass, GatheredPhotons& gathered) const;

    float smallDisc(int pass) const; ///< GatheredPhotons::smallDisc

    /// Takes what a pass has looked up in the tile, and corrects its light. Passes below
    /// kChoosingPasses come in their order, before all others. counted: how often the light of the
    /// pass counts; rgba holds it so many times. alpha: of the radius schedule.
    void finish(int pass, int counted, float alpha, const GatheredPhotons& gathered,
                RgbaLanes* rgba);

    /// Adds what the pixels know of the bias of their discs in the mean of so many passes from the
    /// first one on: to compared the bias of the passes that may choose, to discs that of the later
    /// passes of pixels that still take discs.
    void addBiases(int passes, FootprintBias& compared, FootprintBias& discs) const;

    /// Returns the share of a pixel's light that is that of discs from before it changed over, in
    /// the mean of so many passes from the first one on. The pixel has changed over.
    double discShare(std::size_t pixel, int passes) const;

private:
    /// Those of the passes after the ones that may choose, of pixels that still compare.
    struct LaterDiscs
    {
        /// How many passes, as a share of all, have together the bias of the later ones, if each
        /// has the mean of those that may choose.
        double share = 0.0;
        double shrink2 = 1.0; ///< square of the next pass's radius, in first radii
        int late = 0;         ///< passes that the discs shrink late by
    };
    LaterDiscs laterDiscs(int passes, bool isSmooth) const;
    double sumOfRadii(int passes, bool isSmooth) const;
    double discsUntil(std::size_t pixel, int passes, const LaterDiscs& later) const;
    int countedOf(std::size_t pixel, int half) const;
    void forgetDiscs(int pass, const GatheredPhotons& gathered, RgbaLanes* rgba);
    void addBlur(int pass, const GatheredPhotons& gathered);
    bool takesBlur() const;
    void addDiscAreas(int counted, const GatheredPhotons& gathered);
    void endChoosing();
    float earlierLeak(double alpha) const;
    void takeLeaked(int pass, const GatheredPhotons& gathered, RgbaLanes* rgba) const;

    /// The light that photons have added at first hits in the even and in the odd passes that
    /// looked up discs and might choose [radiance, summed over the passes].
    Vec3 _discs[2][kTilePixels] = {};
    /// The number of the first pass that takes the photons of the footprint; 0: there is none yet.
    uint8_t _changes[kTilePixels] = {};
    /// Whether the light of the pixel's discs leaves the image. Where photons bring all light, a
    /// pixel that has changed over alone among its neighbours may have done so by chance, and would
    /// have more noise without it.
    bool _forgets[kTilePixels] = {};
    bool _forgetsAlone;
    /// The areas of discs in the passes that may choose, over those of the first pass, summed over
    /// the passes by how often they count.
    float _discAreas[kTilePixels] = {};
    bool _wasSmooth[kTilePixels] = {}; ///< SeenPlane::isSmooth before the pass at work
    /// By pass that may choose: how often it counts; 0 before it is made, and for passes that leave
    /// the image.
    uint8_t _counted[kChoosingPasses] = {};
    bool _hasRestarted = false;
    /// What discs without footprints have blurred in the even and the odd passes that may choose,
    /// and their light [radiance, summed over the tile].
    Vec3 _blur[2] = {Vec3(0.0f), Vec3(0.0f)}, _blurred[2] = {Vec3(0.0f), Vec3(0.0f)};
    /// Of these passes: sums over them of the luminance of the light, of that of the blur and of
    /// its square, each pass once, and how many there are.
    float _blurLight = 0.0f, _blurSum = 0.0f, _blurSquares = 0.0f;
    int _blurPasses = 0;
    bool _leaks = false;       ///< true: the discs of the pixels that still compare leak
    float _alpha = 1.0f;       ///< of the radius schedule
    float _earlierLeak = 0.0f; ///< earlierLeak(), once all passes have chosen
};

} // namespace osgRayTrace::engine
