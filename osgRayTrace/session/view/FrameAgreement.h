// FrameAgreement.h - how much of a frame all views of a scene trace alike. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/view/FramePlan.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// What each view of a scene traces in a frame. The defaults are those of a frame before which no
/// view has been traced.
struct FrameWork
{
    static constexpr int kWholePass = 4096;

    int divider = FramePlanner::kFirstDivider; ///< of width and height while the view moves
    int passes = 1;                            ///< whole ones of a view that moves, at that divider
    int progress = kWholePass; ///< of a view at rest, at full resolution, in parts of a pass
    int upsampleDivider =
        FramePlanner::kFirstDivider; ///< of the size that reduced images are upsampled to
};

/// A frame that a view is about to trace.
struct AgreedFrame
{
    uint64_t number = 0;  ///< of the viewer; 0: it counts none
    bool again = false;   ///< the view has traced in this frame, and adds to it
    double seconds = 0.0; ///< that all views together may take to be traced and shown
    bool degrade = true;  ///< the resolution may be reduced while views move
};

/// What a view has traced in a frame.
struct TracedPart
{
    struct Passes
    {
        int tiles = 0;
        double seconds = 0.0; ///< without photons
    };
    Passes full, reduced;       ///< of full resolution, and of reduced
    double photonSeconds = 0.0; ///< traced, or waited for
    int photonPasses = 0;       ///< that were begun
    double lostSeconds = 0.0;   ///< in what was given up
    /// Of a view at rest at full resolution: what it has of the pass that it is at, in parts of it.
    std::optional<int> progress;
    int upsampleDivider = 1; ///< the least for which the view's share of the time suffices
};

/// All views of a scene take the same passes and the same resolution in a frame, so that no edge
/// shows where the walls of a CAVE meet: the most that fits all of them together into the frame's
/// time.
///
/// What they take is decided when the first of them is traced in a frame, from what each has cost
/// in earlier ones, and then holds for the frame, whatever the clock says. The plan has a part for
/// views that move and one for those at rest, and each fits all views: so any mixture of both does.
/// The first image of a view that came when others were there already is of the first divider or
/// coarser, as nobody knows what it costs.
///
/// A view whose tracing has taken farTooLong() is given up, or ends with the
/// passes that it has: it, and those that are traced after it in this frame, take less. That frame
/// alone is not alike in all views.
///
/// Of views that are traced at the same time by several threads, each is charged its share of the
/// clock, as they share the threads that trace. Views that have not been traced in the last kForget
/// frames do not count. Knows no clock: all times are told. Thread safe; its lock is held for
/// moments.
class FrameAgreement
{
public:
    static constexpr int kForget = 8;

    /// After which tracing is given up, if all have so many seconds. Not less: other programs may
    /// stop one view for long, and all are to be alike.
    static constexpr double farTooLong(double seconds)
    {
        return seconds > 0.1 ? 10.0 * seconds : 1.0;
    }

    /// A view's part in the agreement, which ends with the last reference to it.
    class Member;

    FrameAgreement();
    ~FrameAgreement();
    FrameAgreement(const FrameAgreement&) = delete;
    FrameAgreement& operator=(const FrameAgreement&) = delete;

    std::shared_ptr<Member> join();

    /// What the view of width x height traces in the frame. moved: its image is a new one. now [s]
    struct Part
    {
        FrameWork work;
        double share = 1.0; ///< of the time, for what each view does with its image by itself
    };
    Part begin(Member& member, const AgreedFrame& frame, int width, int height, bool moved,
               double now);

    /// The view is given up, after so much of it: what it traces instead.
    FrameWork giveUp(Member& member, const TracedPart& traced);

    /// The view ended with so many passes.
    void cutShort(Member& member, int passes);

    /// The view's image is on its way to the display.
    void end(Member& member, const TracedPart& traced, double now);

    /// What the next frame would take if it had so many seconds; nothing if no view is traced.
    /// Once a frame, by who decides for it with impose().
    std::optional<FrameWork> offer(double seconds, bool degrade);

    /// All frames take this from now on, decided by somebody else; nothing: the agreement decides.
    void impose(const std::optional<FrameWork>& work);

private:
    struct Frame;

    void charge(double now);
    Frame* frameOf(const Member& member);
    Frame& frameFor(Member& member, const AgreedFrame& frame);
    std::vector<std::shared_ptr<Member>> activeMembers();
    FrameWork plan(double seconds, bool degrade);
    int progressWithin(double seconds, double passSeconds) const;

    std::mutex _mutex; // draw threads, and who decides; all below
    std::vector<std::weak_ptr<Member>> _members;
    std::vector<Frame> _frames; ///< the last ones, the newest at the end
    uint64_t _frameCount = 0;
    std::optional<FrameWork> _imposed;
    HeldDivider _divider;
    double _photonPassSeconds = 0.0; ///< of a pass of photons at rest
    double _charged = 0.0;           ///< until when the clock has been charged
};

} // namespace osgRayTrace::engine
