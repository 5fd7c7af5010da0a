// ViewTracerAgreed.cpp - what a view traces in a frame that all views agree on. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewTracer.h"

#include <algorithm>
#include <atomic>

namespace osgRayTrace::engine
{

/// Returns what all views agree on for the frame, if they do.
FrameAgreement::Part ViewTracer::joinFrame(const FrameBudget& budget, bool moved)
{
    if (_agreement != budget.agreement)
    {
        _agreement = budget.agreement;
        _member = _agreement ? _agreement->join() : nullptr;
        _agreedProgress.reset();
    }
    _part = TracedPart();
    if (!_agreement) return {};
    const AgreedFrame frame{budget.frameNumber, budget.again, budget.seconds, budget.degrade};
    return _agreement->begin(*_member, frame, _view.width, _view.height, moved, _begin);
}

void ViewTracer::traceAgreed(bool moved, FrameWork work, double budget)
{
    if (moved)
    {
        if (!traceAgreedImage(work, budget) && _status.ok())
        {
            work = _agreement->giveUp(*_member, _part);
            TracedPart rest;
            rest.lostSeconds = _frame.traceSeconds;
            _part = rest;
            traceAgreedImage(work, 0.0);
        }
        const int passes = image().progress().passes;
        if (passes < std::min(work.passes, _maxPasses)) _agreement->cutShort(*_member, passes);
        _agreedProgress =
            _displayState == DisplayState::Whole ? int64_t(passes) * FrameWork::kWholePass : 0;
    }
    else if (_displayState == DisplayState::Reduced && _stillFrames < kSettling)
    {
        StopRule rule;
        rule.newPasses = work.passes;
        render(*_reduced, _divider, rule, nullptr);
    }
    else
    {
        traceAgreedProgress(work);
    }
}

/// Traces as many passes as all views, at the resolution of all. Returns false if the image was
/// given up or failed. budget is the time of all views [s]; if it is 0, the image is not given up.
bool ViewTracer::traceAgreedImage(const FrameWork& work, double budget)
{
    const int whole =
        tilesOf(reducedSize(_view.width, work.divider), reducedSize(_view.height, work.divider));
    StopRule rule;
    rule.newPasses = work.passes;
    // Photons, which no other resolution makes fewer, do not count: the first question comes after
    // them.
    std::atomic<double> start{-std::numeric_limits<double>::infinity()};
    if (budget > 0.0)
        rule.shouldStop = [&](int tiles, double)
        {
            if (tiles < whole && work.divider >= FramePlanner::kLargestDivider) return false;
            const double now = _now();
            double none = -std::numeric_limits<double>::infinity();
            if (start.compare_exchange_strong(none, now)) return false;
            return now - none > FrameAgreement::farTooLong(budget);
        };
    return renderImage(work.divider, rule);
}

/// Traces the agreed share of the tiles in full resolution: all views at rest have the same share,
/// so that they complete their passes in the same frames.
void ViewTracer::traceAgreedProgress(const FrameWork& work)
{
    constexpr int64_t kWhole = FrameWork::kWholePass;
    const int64_t tiles = tilesOf(_view.width, _view.height);
    const bool begun = _displayState != DisplayState::Reduced;
    const int64_t done =
        begun ? _session->progress().passes * tiles + tiles - _session->tilesLeft() : 0;
    if (!_agreedProgress) _agreedProgress = done * kWhole / tiles;
    _agreedProgress = std::min(*_agreedProgress + work.progress, _maxPasses * kWhole);
    _part.progress = static_cast<int>(*_agreedProgress % kWhole);

    const int64_t wanted = *_agreedProgress * tiles / kWhole;
    if (wanted <= done) return;
    StopRule rule;
    rule.newTiles =
        static_cast<int>(std::min<int64_t>(wanted - done, std::numeric_limits<int>::max()));
    rule.newPasses = static_cast<int>((wanted + tiles - 1) / tiles - done / tiles);
    _part.photonPasses =
        static_cast<int>((wanted + tiles - 1) / tiles - (done + tiles - 1) / tiles);
    addToImage(rule);
}

} // namespace osgRayTrace::engine
