// PassLeases.h - who makes which passes. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/PassSet.h"

#include <optional>
#include <vector>

namespace osgRayTrace::app
{

/// Returns the least number of passes above this one at which an error target is looked at: 2, 4, 8
/// and 16, then four in each octave. What a render with a target ends with then depends neither on
/// the number of its ranks nor on their speed.
int nextGridPoint(int passes);

/// Gives the passes of a picture to ranks in order, each once: as many at a time as a rank makes in
/// two seconds, fewer at the begin, when the speed is not known well, and fewer towards the end, so
/// that all ranks end at about the same time.
class PassLeases
{
public:
    /// Leases the passes of [first, end) that are not done.
    PassLeases(engine::PassSet done, int first, int end, int ranks);

    /// Returns passes for a rank, at least one and all below limit; nothing if there are none. The
    /// rank may be expected to make them within a quarter of the seconds that are left.
    std::optional<engine::PassSet::Range> take(int rank, int limit, double seconds);

    /// Records how long a rank took for passes.
    void finish(int rank, int passes, double seconds);

    /// Returns the least pass that nobody has made or taken, or end.
    int firstLeft() const { return _taken.firstMissing(_first); }

private:
    int left() const;

    engine::PassSet _taken; ///< done or taken
    int _first;
    int _end;
    struct Speed
    {
        double passesPerSecond = 0.0; ///< 0: not known
        int lastPasses = 0;           ///< passes from which it is known
    };
    std::vector<Speed> _speeds; ///< by rank
};

} // namespace osgRayTrace::app
