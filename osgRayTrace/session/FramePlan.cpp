// FramePlan.cpp - how much of a view is traced in a frame. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/FramePlan.h"

#include "osgRayTrace/film/Film.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kNewWeight = 0.25; ///< of the last frame's costs in what is known
constexpr double kSurprise = 1.5;   ///< costs so much larger are believed at once
constexpr double kGiveUp = 1.2;     ///< of the frame: a pass that would take more is given up
constexpr int kMostPasses = 1 << 20;

void learn(double& known, double seen)
{
    const bool surprise = known <= 0.0 || seen > kSurprise * known;
    known = surprise ? seen : known + kNewWeight * (seen - known);
}

} // namespace

int reducedSize(int size, int divider)
{
    return std::max(1, (size + divider / 2) / divider);
}

int tilesOf(int width, int height)
{
    return tilesAlong(width) * tilesAlong(height);
}

double FramePlanner::tileSeconds(int divider) const
{
    if (divider == 1) return _full > 0.0 ? _full : _reduced;
    return _reduced > 0.0 ? _reduced : _full * _ratio;
}

double FramePlanner::passSeconds(const FrameSituation& frame, int divider) const
{
    const int tiles =
        tilesOf(reducedSize(frame.width, divider), reducedSize(frame.height, divider));
    // While coarse images are made, what is known of fine ones grows old: they cost no more a tile.
    const double seconds =
        divider == 1 && !_fullIsNewer && _reduced > 0.0 ? _reduced : tileSeconds(divider);
    return tiles * seconds;
}

/// The largest divider if none fits.
int FramePlanner::finestWithin(const FrameSituation& frame, double share) const
{
    const double room = share * (frame.seconds - _photonSeconds);
    int divider = 1;
    while (divider < kLargestDivider && passSeconds(frame, divider) > room)
        ++divider;
    return divider;
}

int FramePlanner::heldDivider(const FrameSituation& frame)
{
    if (!knowsCosts()) return kFirstDivider;
    if (_divider < 1) return finestWithin(frame, kChosen);

    const double room = frame.seconds - _photonSeconds;
    if (passSeconds(frame, _divider) > kTooMuch * room)
    {
        _roomy = 0;
        return std::max(_divider, finestWithin(frame, kChosen));
    }
    const int finer = finestWithin(frame, kLittle);
    _roomy = finer < _divider ? _roomy + 1 : 0;
    if (_roomy < kPatience) return _divider;
    _roomy = 0;
    return finer;
}

/// So many as the seconds will do, and what is begun of one more.
int FramePlanner::passes(const FrameSituation& frame, int divider, int tilesLeft) const
{
    const double seconds = tileSeconds(divider);
    if (!(seconds > 0.0)) return 1;
    const int tiles =
        tilesOf(reducedSize(frame.width, divider), reducedSize(frame.height, divider));
    const double room = frame.seconds - (frame.moved ? _photonSeconds : 0.0);
    const double after = std::max(0.0, room / seconds - (tilesLeft > 0 ? tilesLeft : tiles));
    return 1 + static_cast<int>(std::min<double>(kMostPasses, std::ceil(after / tiles)));
}

FramePlan FramePlanner::plan(const FrameSituation& frame)
{
    FramePlan plan;
    if (!frame.moved)
    {
        plan.passes = passes(frame, 1, frame.tilesLeft);
        return plan;
    }
    if (frame.degrade)
    {
        if (_fullIsNewer) _reduced = _full * _ratio;
        const bool known = knowsCosts();
        plan.divider = heldDivider(frame);
        if (known) _divider = plan.divider;
    }
    plan.passes = passes(frame, plan.divider, 0);
    return plan;
}

FramePlan FramePlanner::replan(const FrameSituation& frame)
{
    FramePlan plan;
    _divider = _roomy = 0; // the next frame has more time, and knows the costs
    plan.divider = finestWithin(frame, kChosen);
    plan.passes = passes(frame, plan.divider, 0);
    return plan;
}

void FramePlanner::noteTiles(int divider, int tiles, double seconds)
{
    if (tiles <= 0 || !(seconds > 0.0)) return;
    const double seen = seconds / tiles;
    if (divider > 1)
    {
        learn(_reduced, seen);
        _fullIsNewer = false;
        return;
    }
    if (!_fullIsNewer && _reduced > 0.0)
    {
        _full = seen; // the last is of another image
        _ratio = std::clamp(_reduced / seen, 1.0, 2.0);
    }
    learn(_full, seen);
    _fullIsNewer = true;
}

bool FramePlanner::givesUp(const FrameSituation& frame, int divider, int tiles,
                           double seconds) const
{
    const int all = tilesOf(reducedSize(frame.width, divider), reducedSize(frame.height, divider));
    if (!frame.degrade || divider >= kLargestDivider) return false;
    if (tiles < std::max(16, all / 16) || tiles > all / 2)
        return false; // too few to tell, too many to lose
    const double room = frame.seconds - _photonSeconds;
    return std::max(0.0, seconds - _photonSeconds) * all / tiles > kGiveUp * room;
}

} // namespace osgRayTrace::engine
