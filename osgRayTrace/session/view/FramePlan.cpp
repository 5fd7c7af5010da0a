// FramePlan.cpp - how much of a view is traced in a frame. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/FramePlan.h"

#include "osgRayTrace/film/Film.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kNewWeight = 0.25; ///< weight of the last frame's costs in what is known
constexpr double kSurprise = 1.5;   ///< factor by which costs are larger that are believed at once
constexpr double kGiveUp = 1.2;     ///< share of the frame; a pass that would take more is given up
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

View reducedView(View view, int divider)
{
    view.width = reducedSize(view.width, divider);
    view.height = reducedSize(view.height, divider);
    return view;
}

int tilesOf(int width, int height)
{
    return tilesAlong(width) * tilesAlong(height);
}

void TileCosts::record(int divider, int tiles, double seconds)
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
        _full = seen; // the last cost is of another image
        _ratio = std::clamp(_reduced / seen, 1.0, 2.0);
    }
    learn(_full, seen);
    _fullIsNewer = true;
}

double TileCosts::tileSeconds(int divider) const
{
    if (divider == 1) return _full > 0.0 ? _full : _reduced;
    return _reduced > 0.0 ? _reduced : _full * _ratio;
}

double TileCosts::passSeconds(int width, int height, int divider) const
{
    const int tiles = tilesOf(reducedSize(width, divider), reducedSize(height, divider));
    // While coarse images are made, what is known of fine ones grows old: fine images cost no more
    // a tile.
    const double seconds =
        divider == 1 && !_fullIsNewer && _reduced > 0.0 ? _reduced : tileSeconds(divider);
    return tiles * seconds;
}

void TileCosts::expectReduced()
{
    if (_fullIsNewer) _reduced = _full * _ratio;
}

int HeldDivider::finestWithin(const PassSeconds& passSeconds, double seconds)
{
    int divider = 1;
    while (divider < kLargest && passSeconds(divider) > seconds)
        ++divider;
    return divider;
}

int HeldDivider::choose(const PassSeconds& passSeconds, double seconds, bool moves)
{
    if (_divider < 1) return _divider = finestWithin(passSeconds, kChosen * seconds);
    if (passSeconds(_divider) > kTooMuch * seconds)
    {
        _roomy = 0;
        return _divider = std::max(_divider, finestWithin(passSeconds, kChosen * seconds));
    }
    if (!moves) return _divider;
    const int finer = finestWithin(passSeconds, kLittle * seconds);
    _roomy = finer < _divider ? _roomy + 1 : 0;
    if (_roomy < kPatience) return _divider;
    _roomy = 0;
    return _divider = finer;
}

HeldDivider::PassSeconds FramePlanner::passSeconds(const FrameSituation& frame) const
{
    return [this, &frame](int divider)
    {
        // A pass of full resolution may take the same share of the time that it has. If no time
        // is left, its cost stays what it is: it is never the one to choose.
        const bool hasOwn = divider == 1 && frame.fullSeconds > 0.0 && frame.seconds > 0.0;
        const double scale = hasOwn ? frame.seconds / frame.fullSeconds : 1.0;
        return scale * _costs.passSeconds(frame.width, frame.height, divider);
    };
}

/// Returns the number of passes that the seconds suffice for, or suffice to begin.
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
        _costs.expectReduced();
        plan.divider = knowsCosts()
                           ? _divider.choose(passSeconds(frame), frame.seconds - _photonSeconds)
                           : kFirstDivider;
    }
    plan.passes = passes(frame, plan.divider, 0);
    return plan;
}

FramePlan FramePlanner::replan(const FrameSituation& frame)
{
    FramePlan plan;
    _divider.reset(); // the next frame has more time, and knows the costs
    _costs.expectReduced();
    plan.divider = HeldDivider::finestWithin(
        passSeconds(frame), HeldDivider::kChosen * (frame.seconds - _photonSeconds));
    plan.passes = passes(frame, plan.divider, 0);
    return plan;
}

bool FramePlanner::givesUp(const FrameSituation& frame, int divider, int tiles,
                           double seconds) const
{
    const int all = tilesOf(reducedSize(frame.width, divider), reducedSize(frame.height, divider));
    if (!frame.degrade || divider >= kLargestDivider) return false;
    if (tiles < std::max(16, all / 16) || tiles > all / 2)
        return false; // so few tiles do not tell; so many are too many to lose
    const double room = frame.seconds - _photonSeconds;
    return std::max(0.0, seconds - _photonSeconds) * all / tiles > kGiveUp * room;
}

} // namespace osgRayTrace::engine
