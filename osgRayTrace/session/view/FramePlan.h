// FramePlan.h - how much of a view is traced in a frame, going by what tracing has cost. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"

#include <functional>

namespace osgRayTrace::engine
{

/// A frame that is to be planned.
struct FrameSituation
{
    int width = 0, height = 0; ///< of the view [pixels]
    double seconds = 0.0;      ///< that tracing may take
    bool moved = false;        ///< the image is a new one: no part of the last is of use
    bool degrade = true;       ///< of new images the resolution may be reduced
    int tilesLeft = 0; ///< of the full resolution's pass that was begun; 0: none was. Unless moved
};

struct FramePlan
{
    int divider = 1; ///< of width and height; 1: full resolution
    int passes = 1;  ///< to begin; there may be no time for all of the last one
};

/// What a tile of a view has cost, learnt from the passes that were traced. Knows no clock: all
/// times are told.
class TileCosts
{
public:
    /// Tiles of passes that took so many seconds on the clock, all threads together.
    void record(int divider, int tiles, double seconds);

    bool known() const { return _full > 0.0 || _reduced > 0.0; }

    /// Of a tile of the divider's image [s]; 0: not known.
    double tileSeconds(int divider) const;

    /// Of a whole pass of a view of so many pixels, at that divider [s]; 0: not known.
    double passSeconds(int width, int height, int divider) const;

    /// Reduced images are next: their cost follows that of the full resolution if that was seen
    /// last.
    void expectReduced();

private:
    double _full = 0.0;    ///< seconds a tile; 0: not known
    double _reduced = 0.0; ///< the same of images of less resolution, whose rays are less alike
    double _ratio = 1.2;   ///< of the two, when last seen side by side
    bool _fullIsNewer = false;
};

/// The divider of what moves, held from frame to frame: it grows as soon as a pass takes more than
/// kTooMuch of the time there is, and falls if for kPatience frames a finer pass would have taken
/// less than kLittle of it.
class HeldDivider
{
public:
    static constexpr int kLargest = 16;
    static constexpr double kChosen =
        0.75; ///< share of the frame for the whole pass, when a divider is chosen;
    static constexpr double kTooMuch = 0.9; ///< above it the divider grows,
    static constexpr double kLittle = 0.6;  ///< and a lower one whose share is below this is taken
    static constexpr int kPatience = 10;    ///< after so many moved frames

    /// Of a pass at a divider [s].
    using PassSeconds = std::function<double(int divider)>;

    /// The smallest divider whose pass takes no more than the seconds; the largest if none does.
    static int finestWithin(const PassSeconds& passSeconds, double seconds);

    /// The divider of a frame with so many seconds. moves: the frame counts for the patience.
    int choose(const PassSeconds& passSeconds, double seconds, bool moves = true);

    /// The next choice holds nothing.
    void reset() { _divider = _roomy = 0; }

private:
    int _divider = 0; ///< 0: none yet
    int _roomy = 0;   ///< moved frames in which a lower one would have fitted well
};

/// Chooses the resolution of a view while it moves, so that a whole pass of it fits into each frame
/// with room for error, and holds it: it becomes coarser as soon as a pass no longer fits, and
/// finer if one has fitted with more than room to spare for a while. What time is left goes to more
/// passes. A view that rests has its full resolution. Knows no clock: all times are told. One
/// thread at a time.
class FramePlanner
{
public:
    static constexpr int kLargestDivider = HeldDivider::kLargest;
    static constexpr int kFirstDivider = 8; ///< when nothing is known yet

    FramePlan plan(const FrameSituation& frame);

    /// For the rest of a frame whose divider was a guess, or whose pass was given up. seconds: that
    /// are left.
    FramePlan replan(const FrameSituation& frame);

    /// See TileCosts::note.
    void recordTiles(int divider, int tiles, double seconds)
    {
        _costs.record(divider, tiles, seconds);
    }

    /// What the photons of a moved frame took.
    void recordPhotons(double seconds) { _photonSeconds = seconds; }

    /// True if the first pass of a moved frame, with tiles begun in so many of its seconds, would
    /// take so much more than all of them that a coarser one is better.
    bool givesUp(const FrameSituation& frame, int divider, int tiles, double seconds) const;

    bool knowsCosts() const { return _costs.known(); }

    /// Of a tile of the divider's image [s]; 0: not known.
    double tileSeconds(int divider) const { return _costs.tileSeconds(divider); }

private:
    HeldDivider::PassSeconds passSeconds(const FrameSituation& frame) const;
    int passes(const FrameSituation& frame, int divider, int tilesLeft) const;

    TileCosts _costs;
    HeldDivider _divider;
    double _photonSeconds = 0.0;
};

/// Of an image's side: at least a pixel.
int reducedSize(int size, int divider);

/// The same view in fewer pixels.
View reducedView(View view, int divider);

/// Tiles of an image.
int tilesOf(int width, int height);

} // namespace osgRayTrace::engine
