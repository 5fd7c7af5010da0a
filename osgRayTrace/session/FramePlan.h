// FramePlan.h - how much of a view is traced in a frame, going by what tracing has cost. Layer:
// session. SPDX-License-Identifier: MIT
#pragma once

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

/// Chooses the resolution of a view while it moves, so that a whole pass of it fits into each frame
/// with room for error, and holds it: it becomes coarser as soon as a pass no longer fits, and
/// finer if one has fitted with more than room to spare for a while. What time is left goes to more
/// passes. A view that rests has its full resolution. Knows no clock: all times are told. One
/// thread at a time.
class FramePlanner
{
public:
    static constexpr int kLargestDivider = 16;
    static constexpr int kFirstDivider = 8; ///< when nothing is known yet
    static constexpr double kChosen =
        0.75; ///< share of the frame for the whole pass, when a divider is chosen;
    static constexpr double kTooMuch = 0.9; ///< above it the divider grows,
    static constexpr double kLittle = 0.6;  ///< and a lower one whose share is below this is taken
    static constexpr int kPatience = 10;    ///< after so many moved frames

    FramePlan plan(const FrameSituation& frame);

    /// For the rest of a frame whose divider was a guess, or whose pass was given up. seconds: that
    /// are left.
    FramePlan replan(const FrameSituation& frame);

    /// Tiles of passes that took so many seconds on the clock, all threads together.
    void noteTiles(int divider, int tiles, double seconds);

    /// What the photons of a moved frame took.
    void notePhotons(double seconds) { _photonSeconds = seconds; }

    /// True if the first pass of a moved frame, with tiles begun in so many of its seconds, would
    /// take so much more than all of them that a coarser one is better.
    bool givesUp(const FrameSituation& frame, int divider, int tiles, double seconds) const;

    bool knowsCosts() const { return _full > 0.0 || _reduced > 0.0; }

    /// Of a tile of the divider's image [s]; 0: not known.
    double tileSeconds(int divider) const;

private:
    double passSeconds(const FrameSituation& frame, int divider) const;
    int finestWithin(const FrameSituation& frame, double share) const;
    int heldDivider(const FrameSituation& frame);
    int passes(const FrameSituation& frame, int divider, int tilesLeft) const;

    double _full = 0.0;    ///< seconds a tile; 0: not known
    double _reduced = 0.0; ///< the same of images of less resolution, whose rays are less alike
    double _ratio = 1.2;   ///< of the two, when last seen side by side
    bool _fullIsNewer = false;
    double _photonSeconds = 0.0;
    int _divider = 0; ///< held; 0: none yet
    int _roomy = 0;   ///< moved frames in which a lower one would have fitted well
};

/// Of an image's side: at least a pixel.
int reducedSize(int size, int divider);

/// Of an image.
int tilesOf(int width, int height);

} // namespace osgRayTrace::engine
