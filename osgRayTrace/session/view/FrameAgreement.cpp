// FrameAgreement.cpp - what all views cost together, and what they may trace. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/FrameAgreement.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kFilled =
    0.95; ///< share of the time that is given away: costs vary from frame to frame
constexpr double kLeastShare = 0.2; ///< share of a frame that is traced in, whatever comes after
constexpr int kMostPasses = 1024;   ///< passes of a frame
constexpr int kLeastProgress =
    FrameWork::kWholePass / 256; ///< progress of a frame at least, so that an image is completed
constexpr std::size_t kKeptFrames = 4; ///< frames of several viewers, or whose draws overlap
constexpr double kCopySeconds =
    2e-9; ///< time that the display takes for a pixel, until it is known

/// Moves what is known towards what was seen. The time of the display is often disturbed for a
/// frame, more so the more views there are: no such time is believed at once.
void learn(double& known, double seen)
{
    known = known > 0.0 ? known + 0.25 * (seen - known) : seen;
}

} // namespace

class FrameAgreement::Member
{
    friend class FrameAgreement;

    int width = 0, height = 0;
    TileCosts costs;
    double photonSeconds = 0.0;                ///< time of the view's last frame in which it moved
    double afterMoved = 0.0, afterStill = 0.0; ///< time that a frame takes beside tracing
    /// Sums over the view's last frames at rest at full resolution, each of which weighs a tenth
    /// less than the next: so few tiles as are traced in a frame may each seem dear by chance.
    double stillTiles = 0.0, stillSeconds = 0.0;
    int upsampleDivider = 1;
    uint64_t frame = 0; ///< number of the view's last frame, as _frameCount had it

    // The view's present frame.
    bool tracing = false;
    bool moved = false;
    double begun = 0.0;
    double charged = 0.0; ///< seconds charged since
};

struct FrameAgreement::Frame
{
    uint64_t number = 0; ///< the viewer's number
    uint64_t count = 0;
    double seconds = 0.0;
    FrameWork work;
    bool known = false; ///< whether it is known what some view costs
    bool moved = false; ///< whether some view moved
    std::size_t views = 1;
    double photonSeconds = 0.0; ///< time of all views at rest
    int photonPasses = 0;       ///< photon passes that any of them has begun
    int progress = 0;           ///< progress of the views at rest when they ended
};

FrameAgreement::FrameAgreement() = default;
FrameAgreement::~FrameAgreement() = default;

std::shared_ptr<FrameAgreement::Member> FrameAgreement::join()
{
    const std::shared_ptr<Member> member(new Member);
    std::lock_guard<CheckedMutex> lock(_mutex);
    const auto gone = [](const std::weak_ptr<Member>& weak) { return weak.expired(); };
    _members.erase(std::remove_if(_members.begin(), _members.end(), gone), _members.end());
    _members.push_back(member);
    return member;
}

/// Charges each of the views at work an equal share of the time since the last charge.
void FrameAgreement::charge(double now)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    std::vector<std::shared_ptr<Member>> tracing;
    for (const std::weak_ptr<Member>& weak : _members)
        if (std::shared_ptr<Member> member = weak.lock(); member && member->tracing)
            tracing.push_back(std::move(member));
    for (const std::shared_ptr<Member>& member : tracing)
        member->charged += std::max(0.0, now - _charged) / static_cast<double>(tracing.size());
    _charged = now;
}

std::vector<std::shared_ptr<FrameAgreement::Member>> FrameAgreement::activeMembers()
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    std::vector<std::shared_ptr<Member>> active;
    for (const std::weak_ptr<Member>& weak : _members)
        if (std::shared_ptr<Member> member = weak.lock();
            member && member->frame > 0 && member->frame + kForget > _frameCount)
            active.push_back(std::move(member));
    return active;
}

/// Returns the frame as it has been decided, or a new one.
FrameAgreement::Frame& FrameAgreement::frameFor(Member& member, const AgreedFrame& frame)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    for (auto decided = _frames.rbegin(); decided != _frames.rend(); ++decided)
    {
        const bool same =
            frame.number == 0 ? decided == _frames.rbegin() : decided->number == frame.number;
        if (same && (frame.again || member.frame != decided->count)) return *decided;
    }
    if (!_frames.empty() && _frames.back().photonPasses > 0)
        learn(_photonPassSeconds, _frames.back().photonSeconds / _frames.back().photonPasses);

    Frame next;
    next.number = frame.number;
    next.seconds = frame.seconds;
    next.work = _imposed ? *_imposed : plan(frame.seconds, frame.degrade);
    const auto active = activeMembers();
    next.views = std::max<std::size_t>(active.size(), 1);
    for (const std::shared_ptr<Member>& other : active)
        next.known |= other->costs.known();
    next.count = ++_frameCount;
    if (_frames.size() == kKeptFrames) _frames.erase(_frames.begin());
    _frames.push_back(next);
    return _frames.back();
}

FrameAgreement::Part FrameAgreement::begin(Member& member, const AgreedFrame& frame, int width,
                                           int height, bool moved, double now)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    Frame& decided = frameFor(member, frame);
    charge(now);
    member.width = width;
    member.height = height;
    member.frame = decided.count;
    member.tracing = true;
    member.moved = moved;
    member.begun = now;
    member.charged = 0.0;
    decided.moved |= moved;
    Part part{decided.work, 1.0 / static_cast<double>(decided.views)};
    if (!member.costs.known() && decided.known)
    {
        part.work.divider = std::max(part.work.divider, FramePlanner::kFirstDivider);
        part.work.passes = 1;
    }
    if (!frame.degrade) part.work.divider = 1;
    return part;
}

/// Returns the member's frame, or null if that frame is long ago.
FrameAgreement::Frame* FrameAgreement::frameOf(const Member& member)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    const auto isIts = [&](const Frame& frame) { return frame.count == member.frame; };
    const auto found = std::find_if(_frames.begin(), _frames.end(), isIts);
    return found == _frames.end() ? nullptr : &*found;
}

FrameWork FrameAgreement::giveUp(Member& member, const TracedPart& traced)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    member.costs.record(1, traced.full.tiles, traced.full.seconds);
    member.costs.record(2, traced.reduced.tiles, traced.reduced.seconds);
    member.costs.expectReduced();
    _divider.reset();
    Frame* frame = frameOf(member);
    FrameWork work = frame ? frame->work : FrameWork();
    const auto passSeconds = [&](int divider)
    { return member.costs.passSeconds(member.width, member.height, divider); };
    const double seconds = frame ? frame->seconds : 0.0;
    const int fitting = HeldDivider::finestWithin(passSeconds, HeldDivider::kChosen * seconds);
    work.divider = std::min(std::max(work.divider + 1, fitting), HeldDivider::kLargest);
    work.passes = 1;
    if (frame) frame->work = work;
    return work;
}

void FrameAgreement::cutShort(Member& member, int passes)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    if (Frame* frame = frameOf(member)) frame->work.passes = std::min(frame->work.passes, passes);
}

void FrameAgreement::end(Member& member, const TracedPart& traced, double now)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    if (!member.tracing) return;
    charge(now);
    member.tracing = false;
    const double seconds = now - member.begun;
    const double share = seconds > 0.0 ? member.charged / seconds : 1.0;
    member.upsampleDivider = traced.upsampleDivider;
    member.costs.record(1, traced.full.tiles, share * traced.full.seconds);
    member.costs.record(2, traced.reduced.tiles, share * traced.reduced.seconds);
    constexpr double kFading = 0.9;
    member.stillTiles = member.moved ? 0.0 : kFading * member.stillTiles + traced.full.tiles;
    member.stillSeconds =
        member.moved ? 0.0 : kFading * member.stillSeconds + share * traced.full.seconds;
    if (member.moved) member.photonSeconds = share * traced.photonSeconds;
    if (traced.full.tiles + traced.reduced.tiles > 0)
    {
        const double tracing = traced.full.seconds + traced.reduced.seconds + traced.photonSeconds +
                               traced.lostSeconds;
        learn(member.moved ? member.afterMoved : member.afterStill,
              std::max(0.0, share * (seconds - tracing)));
    }
    Frame* frame = frameOf(member);
    if (!frame || member.moved) return;
    frame->photonSeconds += share * traced.photonSeconds;
    frame->photonPasses = std::max(frame->photonPasses, traced.photonPasses);
    if (traced.progress) frame->progress = *traced.progress;
}

std::optional<FrameWork> FrameAgreement::offer(double seconds, bool degrade)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    if (activeMembers().empty()) return std::nullopt;
    return plan(seconds, degrade);
}

void FrameAgreement::impose(const std::optional<FrameWork>& work)
{
    std::lock_guard<CheckedMutex> lock(_mutex);
    _imposed = work;
}

FrameWork FrameAgreement::plan(double seconds, bool degrade)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    FrameWork work;
    if (!degrade) work.divider = 1;
    std::vector<std::shared_ptr<Member>> views = activeMembers();
    const auto unknown = [](const std::shared_ptr<Member>& view) { return !view->costs.known(); };
    views.erase(std::remove_if(views.begin(), views.end(), unknown), views.end());
    if (views.empty()) return work;

    work.upsampleDivider = 1;
    double afterMoved = 0.0, afterStill = 0.0, photons = 0.0;
    for (const std::shared_ptr<Member>& view : views)
    {
        const double guess = kCopySeconds * view->width * view->height;
        afterMoved += view->afterMoved > 0.0 ? view->afterMoved : guess;
        afterStill += view->afterStill > 0.0 ? view->afterStill : guess;
        photons += view->photonSeconds;
        view->costs.expectReduced();
        work.upsampleDivider = std::max(work.upsampleDivider, view->upsampleDivider);
    }
    const auto passSeconds = [&](int divider)
    {
        double sum = 0.0;
        for (const std::shared_ptr<Member>& view : views)
            sum += view->costs.passSeconds(view->width, view->height, divider);
        return sum;
    };
    const double whileMoving = std::max(seconds - afterMoved, kLeastShare * seconds) - photons;
    const bool moves = _frames.empty() || _frames.back().moved;
    if (degrade) work.divider = _divider.choose(passSeconds, whileMoving, moves);
    const double passes = kFilled * whileMoving / passSeconds(work.divider);
    work.passes = static_cast<int>(std::clamp(std::floor(passes), 1.0, double(kMostPasses)));
    const double atRest = std::max(seconds - afterStill, kLeastShare * seconds);
    double wholePass = 0.0;
    for (const std::shared_ptr<Member>& view : views)
        wholePass +=
            view->stillTiles >= 1.0
                ? tilesOf(view->width, view->height) * view->stillSeconds / view->stillTiles
                : view->costs.passSeconds(view->width, view->height, 1);
    work.progress = progressWithin(kFilled * atRest, wholePass);
    return work;
}

/// Returns the progress that the views at rest reach. They go on from the progress at which they
/// ended in the last frame. Photons of a pass are traced once, before any of the pass's tiles.
int FrameAgreement::progressWithin(double seconds, double passSeconds) const
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    constexpr double kWhole = FrameWork::kWholePass;
    const int last = _frames.empty() ? 0 : _frames.back().progress % FrameWork::kWholePass;
    double progress = 0.0, left = seconds;
    if (last > 0)
    {
        progress = std::min(1.0 - last / kWhole, left / passSeconds);
        left -= progress * passSeconds;
    }
    const double whole = std::floor(left / (_photonPassSeconds + passSeconds));
    progress += whole;
    left -= whole * (_photonPassSeconds + passSeconds);
    progress += std::max(0.0, left - _photonPassSeconds) / passSeconds;
    const double parts = std::min(std::floor(progress * kWhole), kMostPasses * kWhole);
    return std::max(static_cast<int>(parts), kLeastProgress);
}

} // namespace osgRayTrace::engine
