// FrameAgreement.h - how much of a frame all views of a scene trace alike. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/CheckedMutex.h"
#include "osgRayTrace/session/view/FramePlan.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// The work that each view of a scene traces in a frame. The defaults are those of a frame before
/// which no view has been traced.
struct FrameWork
{
    static constexpr int kWholePass = 4096;

    int divider = FramePlanner::kFirstDivider; ///< divider while the view moves
    int passes = 1;            ///< whole passes of a view that moves, at that divider
    int progress = kWholePass; ///< parts of a pass, of a view at rest at full resolution
    int upsampleDivider =
        FramePlanner::kFirstDivider; ///< divider of the size that reduced images are upsampled to
};

/// A frame that a view is about to trace.
struct AgreedFrame
{
    uint64_t number = 0;  ///< number of the viewer's frame; 0: the viewer counts none
    bool again = false;   ///< whether the view has traced in this frame already, and adds to it
    double seconds = 0.0; ///< time that all views together may take to be traced and shown
    bool degrade = true;  ///< whether the resolution may be reduced while views move
};

/// The part of a frame that a view has traced.
struct TracedPart
{
    struct Passes
    {
        int tiles = 0;
        double seconds = 0.0; ///< time without photons
    };
    Passes full, reduced;       ///< passes of full resolution, and of reduced
    double photonSeconds = 0.0; ///< time in which photons were traced or waited for
    int photonPasses = 0;       ///< photon passes that were begun
    double lostSeconds = 0.0;   ///< time in what was given up
    /// Progress of a view at rest at full resolution: the parts that the view has of the pass at
    /// work.
    std::optional<int> progress;
    int upsampleDivider = 1; ///< the least divider for which the view's share of the time suffices
};

/// All views of a scene take the same passes and the same resolution in a frame, so that no edge
/// shows at a place where two walls of a CAVE meet: the most that fits all views together into the
/// frame's time.
///
/// The agreement decides what the views take when the first of them is traced in a frame, from what
/// each view has cost in earlier frames; the decision then holds for the frame, whatever the clock
/// says. The plan has a part for views that move and one for those at rest, and each part fits all
/// views: so any mixture of both does. If a view comes when others are there already, its first
/// image is of the first divider or coarser, as nobody knows what the view costs.
///
/// A view whose tracing has taken farTooLong() is given up, or ends with the passes that it has:
/// this view, and those that are traced after it in this frame, take less. That frame alone is not
/// alike in all views.
///
/// If several threads trace views at the same time, each view is charged its share of the clock, as
/// the views share the threads that trace. Views that have not been traced in the last kForget
/// frames do not count. The agreement knows no clock: all times are told. It is thread safe; its
/// lock is held for moments.
class FrameAgreement
{
public:
    static constexpr int kForget = 8;

    /// Returns the time after which tracing is given up, if all views have so many seconds. The
    /// time is not shorter because other programs may stop one view for long, and all views are to
    /// be alike.
    static constexpr double farTooLong(double seconds)
    {
        return seconds > 0.1 ? 10.0 * seconds : 1.0;
    }

    /// A member is a view's part in the agreement, which ends with the last reference to the
    /// member.
    class Member;

    FrameAgreement();
    ~FrameAgreement();
    FrameAgreement(const FrameAgreement&) = delete;
    FrameAgreement& operator=(const FrameAgreement&) = delete;

    std::shared_ptr<Member> join();

    /// Returns the part of the view of width x height in the frame. moved says that the view's
    /// image is a new one; now is a time [s].
    struct Part
    {
        FrameWork work;
        double share = 1.0; ///< share of the time for what each view does with its image by itself
    };
    Part begin(Member& member, const AgreedFrame& frame, int width, int height, bool moved,
               double now);

    /// Records that the view is given up after tracing this part. Returns what the view traces
    /// instead.
    FrameWork giveUp(Member& member, const TracedPart& traced);

    /// Records that the view ended with so many passes.
    void cutShort(Member& member, int passes);

    /// Records that the view's image is on its way to the display.
    void end(Member& member, const TracedPart& traced, double now);

    /// Returns what the next frame would take if it had so many seconds; nothing if no view is
    /// traced. Whoever decides for the frame with impose() calls it once a frame.
    std::optional<FrameWork> offer(double seconds, bool degrade);

    /// Sets what all frames take from now on, decided by somebody else; with nothing the agreement
    /// decides.
    void impose(const std::optional<FrameWork>& work);

private:
    struct Frame;

    void charge(double now);
    Frame* frameOf(const Member& member);
    Frame& frameFor(Member& member, const AgreedFrame& frame);
    std::vector<std::shared_ptr<Member>> activeMembers();
    FrameWork plan(double seconds, bool degrade);
    int progressWithin(double seconds, double passSeconds) const;

    CheckedMutex _mutex; // draw threads and whoever decides lock it; it guards all members below
    std::vector<std::weak_ptr<Member>> _members;
    std::vector<Frame> _frames; ///< the last frames, the newest at the end
    uint64_t _frameCount = 0;
    std::optional<FrameWork> _imposed;
    HeldDivider _divider;
    double _photonPassSeconds = 0.0; ///< time of a pass of photons at rest
    double _charged = 0.0;           ///< the time until which the clock has been charged
};

} // namespace osgRayTrace::engine
