// FramePlan.h - how much of a view is traced in a frame, by earlier costs. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"

#include <functional>

namespace osgRayTrace::engine
{

/// A frame that is to be planned.
struct FrameSituation
{
    int width = 0, height = 0; ///< size of the view [pixels]
    double seconds = 0.0;      ///< time that tracing may take
    /// The same for an image of full resolution, which is not upsampled; 0: as long as seconds.
    double fullSeconds = 0.0;
    bool moved = false;  ///< whether the image is a new one: no part of the last is of use
    bool degrade = true; ///< whether the resolution of new images may be reduced
    int tilesLeft = 0;   ///< tiles left of a begun full pass; 0: none. Unless moved
};

struct FramePlan
{
    int divider = 1; ///< divider of width and height; 1: full resolution
    int passes = 1;  ///< passes to begin; there may be no time for all of the last one
};

/// TileCosts holds what a tile of a view has cost, learnt from the passes that were traced. It
/// knows no clock: all times are told.
class TileCosts
{
public:
    /// Records the tiles of passes that took so many seconds on the clock, all threads together.
    void record(int divider, int tiles, double seconds);

    bool known() const { return _full > 0.0 || _reduced > 0.0; }

    /// Returns the time of a tile of the divider's image [s]; 0: not known.
    double tileSeconds(int divider) const;

    /// Returns the time of a whole pass of a view of so many pixels at that divider [s]; 0: not
    /// known.
    double passSeconds(int width, int height, int divider) const;

    /// Makes the cost of reduced images, which are next, follow that of the full resolution if the
    /// latter was seen last.
    void expectReduced();

private:
    double _full = 0.0;    ///< seconds a tile; 0: not known
    double _reduced = 0.0; ///< seconds a tile of reduced images, whose rays are less alike
    double _ratio = 1.2;   ///< _reduced / _full, when last seen side by side
    bool _fullIsNewer = false;
};

/// The divider of a view that moves, held from frame to frame: it grows as soon as a pass takes
/// more than kTooMuch of the time there is, and falls if for kPatience frames a finer pass would
/// have taken less than kLittle of that time.
class HeldDivider
{
public:
    static constexpr int kLargest = 32;
    static constexpr double kChosen =
        0.75; ///< share of the frame for the whole pass, when a divider is chosen
    static constexpr double kTooMuch = 0.9; ///< share above which the divider grows
    static constexpr double kLittle = 0.6;  ///< share below which a lower divider is taken
    static constexpr int kPatience = 10;    ///< moved frames before a lower divider is taken

    /// A function that returns the time of a pass at a divider [s].
    using PassSeconds = std::function<double(int divider)>;

    /// Returns the smallest divider whose pass takes no more than the seconds, or the largest if
    /// none does.
    static int finestWithin(const PassSeconds& passSeconds, double seconds);

    /// Returns the divider of a frame with so many seconds. moves says that the frame counts for
    /// the patience.
    int choose(const PassSeconds& passSeconds, double seconds, bool moves = true);

    /// Forgets the divider: the next choice holds nothing.
    void reset() { _divider = _roomy = 0; }

private:
    int _divider = 0; ///< the divider; 0: none yet
    int _roomy = 0;   ///< moved frames in which a lower one would have fitted well
};

/// FramePlanner chooses the resolution of a view while the view moves, so that a whole pass fits
/// into each frame with room for error, and holds the resolution: it becomes coarser as soon as a
/// pass no longer fits, and finer if one has fitted with more than room to spare for a while. The
/// time that is left goes to more passes. A view that rests has its full resolution. The planner
/// knows no clock: all times are told. One thread at a time may use it, which the ViewTracer that
/// owns it asserts.
class FramePlanner
{
public:
    static constexpr int kLargestDivider = HeldDivider::kLargest;
    static constexpr int kFirstDivider = 8; ///< divider when nothing is known yet

    FramePlan plan(const FrameSituation& frame);

    /// Returns the plan for the rest of a frame whose divider was a guess, or whose pass was given
    /// up. The frame's seconds are those that are left.
    FramePlan replan(const FrameSituation& frame);

    /// Records tiles, see TileCosts::record.
    void recordTiles(int divider, int tiles, double seconds)
    {
        _costs.record(divider, tiles, seconds);
    }

    /// Records what the photons of a moved frame took.
    void recordPhotons(double seconds) { _photonSeconds = seconds; }

    /// Returns true if the first pass of a moved frame, with tiles begun in so many of the frame's
    /// seconds, would take so much more than all the seconds that a coarser pass is better.
    bool givesUp(const FrameSituation& frame, int divider, int tiles, double seconds) const;

    bool knowsCosts() const { return _costs.known(); }

    /// Returns the time of a tile of the divider's image [s]; 0: not known.
    double tileSeconds(int divider) const { return _costs.tileSeconds(divider); }

private:
    HeldDivider::PassSeconds passSeconds(const FrameSituation& frame) const;
    int passes(const FrameSituation& frame, int divider, int tilesLeft) const;

    TileCosts _costs;
    HeldDivider _divider;
    double _photonSeconds = 0.0;
};

/// Returns the reduced side of an image, which is a pixel at least.
int reducedSize(int size, int divider);

/// Returns the same view in fewer pixels.
View reducedView(View view, int divider);

/// Returns the number of tiles of an image.
int tilesOf(int width, int height);

} // namespace osgRayTrace::engine
