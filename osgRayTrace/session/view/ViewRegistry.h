// ViewRegistry.h - which state belongs to the pass that draws now. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/CheckedMutex.h"
#include "osgRayTrace/session/view/DepthSlices.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// A host name names an object of the host: two names are equal if they are of one object. The
/// object's address would not do, as a later object may get the address of a deleted one; a name
/// keeps its value in use.
using HostName = std::shared_ptr<const void>;

/// One pass over a scene.
struct PassIdentity
{
    HostName camera;
    HostName renderStage; ///< one stage for each eye; viewers may alternate two sets
    unsigned int contextId = 0;
    uint64_t frameNumber = 0;      ///< the viewer's frame number; 0: the viewer counts none
    std::array<int, 4> viewport{}; ///< x, y, width, height
    View view;
};

/// The states of all views are found again frame after frame.
///
/// A view is a camera, a context and an eye, and the viewport if one pass draws several. The eye is
/// the place of the render stage among those that draw for the camera in this frame: neither
/// matrices nor traversal masks nor cull visitors tell eyes apart in all of OSG's and its
/// frameworks' stereo modes. If one of the stages does not draw in a frame, a view at rest is known
/// by its matrices. A pass that draws the scene several times has a view for each time. A view
/// whose viewport changes (a window is resized) keeps its state.
///
/// Passes of a frame that differ in nothing but their depths, DepthSlices, share one state.
///
/// A view that did not draw for kExpiry rounds is forgotten; a round ends when some view draws for
/// the second time. Of the views that drew once only the last kMostSingles are kept: a program that
/// makes a camera for each picture never ends a round.
///
/// The registry is thread safe; the states are shared, and may outlive their entry while a draw
/// thread uses them.
template <class State> class ViewRegistry
{
public:
    static constexpr uint64_t kExpiry = 120;        ///< rounds
    static constexpr std::size_t kMostTimes = 8;    ///< views of a pass that draws the scene often
    static constexpr std::size_t kMostSingles = 32; ///< views of a context that drew once

    struct Pass
    {
        std::shared_ptr<State> state;
        /// Whether another slice of this frame has drawn, so that its picture is that of this pass,
        /// too.
        bool shared = false;
        std::vector<View> slices; ///< slices of this frame or the last; one: there are no others
    };

    /// Records that the pass will be drawn. Cull threads call it.
    void record(const PassIdentity& pass)
    {
        if (!depthPlanes(pass.view)) return;
        std::lock_guard<CheckedMutex> lock(_mutex);
        const auto recorded =
            std::find_if(_recorded.begin(), _recorded.end(),
                         [&](const PassIdentity& n)
                         { return sameCamera(n, pass) && n.renderStage == pass.renderStage; });
        if (recorded != _recorded.end())
            *recorded = pass;
        else
            _recorded.push_back(pass);
        if (_recorded.size() > kMostRecorded) _recorded.erase(_recorded.begin());
    }

    /// Returns the state of the pass; for a new view make() makes the state. Draw threads call it.
    template <class Make> Pass acquire(const PassIdentity& pass, Make make)
    {
        std::lock_guard<CheckedMutex> lock(_mutex);
        const std::size_t eye = eyeOf(pass);
        if (Entry* shown = findPresented(pass))
        {
            shown->slices.push_back(pass.view);
            return {shown->state, true, allSlices(*shown, pass)};
        }
        Entry* entry = find(pass, eye);
        if (!entry)
        {
            forgetSingles(pass);
            _entries.push_back({pass, eye, timesDrawn(pass, eye), _round, make(), {}, {}});
            entry = &_entries.back();
        }
        else
        {
            if (entry->round == _round) ++_round;
            entry->again = true;
        }
        entry->pass = pass;
        entry->round = _round;
        entry->lastSlices = std::move(entry->slices);
        entry->slices = {pass.view};
        Pass found{entry->state, false, allSlices(*entry, pass)};
        expire();
        return found;
    }

    /// Forgets the views of a context whose objects are to go, for example before the context is
    /// closed. Any thread may call it.
    void forgetContext(unsigned int contextId)
    {
        std::vector<Entry> gone; // the entries are destroyed without the lock
        std::lock_guard<CheckedMutex> lock(_mutex);
        const auto others =
            std::partition(_entries.begin(), _entries.end(),
                           [&](const Entry& entry) { return entry.pass.contextId != contextId; });
        std::move(others, _entries.end(), std::back_inserter(gone));
        _entries.erase(others, _entries.end());
        const auto ofFrame = [&](const CameraFrame& f) { return f.pass.contextId == contextId; };
        _frames.erase(std::remove_if(_frames.begin(), _frames.end(), ofFrame), _frames.end());
        const auto ofNote = [&](const PassIdentity& n) { return n.contextId == contextId; };
        _recorded.erase(std::remove_if(_recorded.begin(), _recorded.end(), ofNote),
                        _recorded.end());
    }

    /// Returns all states. Any thread may call it.
    std::vector<std::shared_ptr<State>> states() const
    {
        std::lock_guard<CheckedMutex> lock(_mutex);
        std::vector<std::shared_ptr<State>> result;
        for (const Entry& entry : _entries)
            result.push_back(entry.state);
        return result;
    }

private:
    static constexpr std::size_t kMostRecorded = 64;

    struct Entry
    {
        PassIdentity pass; ///< the last pass; of slices the first one
        std::size_t eye;
        std::size_t time; ///< how often the pass had drawn the scene before
        uint64_t round;
        std::shared_ptr<State> state;
        std::vector<View> slices;     ///< the slices that drew since the first did so
        std::vector<View> lastSlices; ///< the slices of the frame before
        bool again = false;           ///< whether the view has drawn more than once
    };

    /// The stages that drew for a camera in its frame, in order.
    struct CameraFrame
    {
        PassIdentity pass;
        uint64_t round;
        std::vector<HostName> stages;
    };

    static bool sameCamera(const PassIdentity& a, const PassIdentity& b)
    {
        return a.camera == b.camera && a.contextId == b.contextId;
    }

    static bool sameFrame(const PassIdentity& a, const PassIdentity& b)
    {
        return a.frameNumber == b.frameNumber && a.frameNumber != 0;
    }

    std::size_t eyeOf(const PassIdentity& pass)
    {
        OSGRAYTRACE_ASSERT(_mutex.isHeld());
        auto frame = std::find_if(_frames.begin(), _frames.end(),
                                  [&](const CameraFrame& f) { return sameCamera(f.pass, pass); });
        if (frame == _frames.end()) frame = _frames.insert(frame, CameraFrame{pass, _round, {}});
        if (frame->pass.frameNumber != pass.frameNumber) frame->stages.clear();
        frame->pass = pass;
        frame->round = _round;

        auto& stages = frame->stages;
        const auto stage = std::find(stages.begin(), stages.end(), pass.renderStage);
        if (stage != stages.end()) return static_cast<std::size_t>(stage - stages.begin());
        stages.push_back(pass.renderStage);
        return stages.size() - 1;
    }

    /// Finds the view that another slice of the pass's picture has drawn in this frame.
    Entry* findPresented(const PassIdentity& pass)
    {
        OSGRAYTRACE_ASSERT(_mutex.isHeld());
        if (!depthPlanes(pass.view)) return nullptr;
        for (Entry& entry : _entries)
        {
            if (entry.pass.contextId != pass.contextId || entry.pass.viewport != pass.viewport ||
                entry.pass.frameNumber != pass.frameNumber ||
                !sameRays(entry.pass.view, pass.view) || !depthPlanes(entry.pass.view))
                continue;
            const auto drawn = [&](const View& slice) { return sameDepth(slice, pass.view); };
            if (std::none_of(entry.slices.begin(), entry.slices.end(), drawn)) return &entry;
        }
        return nullptr;
    }

    /// Returns all known slices of the picture: those of this frame, those that are recorded, and
    /// those of the last frame if there were more, as cull may come after draw.
    std::vector<View> allSlices(const Entry& entry, const PassIdentity& pass) const
    {
        OSGRAYTRACE_ASSERT(_mutex.isHeld());
        std::vector<View> slices = {pass.view};
        if (!depthPlanes(pass.view)) return slices;
        const auto add = [&](const View& view)
        {
            const auto known = [&](const View& slice) { return sameDepth(slice, view); };
            if (sameRays(view, pass.view) && std::none_of(slices.begin(), slices.end(), known))
                slices.push_back(view);
        };
        for (const View& slice : entry.slices)
            add(slice);
        for (const PassIdentity& recorded : _recorded)
            if (recorded.frameNumber == pass.frameNumber && recorded.contextId == pass.contextId)
                add(recorded.view);
        if (entry.lastSlices.size() <= slices.size()) return slices;
        for (const View& last : entry.lastSlices)
            add(withDepthOf(pass.view, last)); // the picture may have moved since the last frame
        return slices;
    }

    bool sameView(const Entry& entry, const PassIdentity& pass, std::size_t eye) const
    {
        return sameCamera(entry.pass, pass) && entry.eye == eye &&
               entry.pass.viewport == pass.viewport;
    }

    /// Counts how often the view has drawn the scene in this frame, each time from another place.
    std::size_t timesDrawn(const PassIdentity& pass, std::size_t eye) const
    {
        OSGRAYTRACE_ASSERT(_mutex.isHeld());
        std::size_t times = 0;
        for (const Entry& entry : _entries)
            times += sameView(entry, pass, eye) && sameFrame(entry.pass, pass);
        return std::min(times, kMostTimes - 1);
    }

    /// Finds the view itself, a view of the camera at rest whose eye is not the same for this
    /// frame, or one of the same eye that did not draw in this frame, whose viewport changed.
    Entry* find(const PassIdentity& pass, std::size_t eye)
    {
        const std::size_t time = timesDrawn(pass, eye);
        Entry *itself = nullptr, *atRest = nullptr, *moved = nullptr;
        for (Entry& entry : _entries)
        {
            if (!sameCamera(entry.pass, pass)) continue;
            const bool resting = sameRays(entry.pass.view, pass.view);
            if (sameView(entry, pass, eye) && resting && sameFrame(entry.pass, pass)) return &entry;
            if (sameView(entry, pass, eye) && entry.time == time) itself = &entry;
            if (sameFrame(entry.pass, pass)) continue;
            if (entry.pass.viewport == pass.viewport && resting && pass.frameNumber)
                atRest = &entry;
            if (entry.eye == eye && entry.time == time &&
                entry.pass.frameNumber != pass.frameNumber)
                moved = &entry;
        }
        if (itself && (!atRest || sameRays(itself->pass.view, pass.view))) return itself;
        return atRest ? atRest : moved;
    }

    /// Makes room before a new view is made: of the views of the new view's context that drew once,
    /// the last kMostSingles - 1 stay.
    void forgetSingles(const PassIdentity& pass)
    {
        OSGRAYTRACE_ASSERT(_mutex.isHeld());
        const auto single = [&](const Entry& entry)
        { return !entry.again && entry.pass.contextId == pass.contextId; };
        const auto count = std::count_if(_entries.begin(), _entries.end(), single);
        if (static_cast<std::size_t>(count) < kMostSingles) return;
        const auto oldest = std::find_if(_entries.begin(), _entries.end(), single);
        const PassIdentity gone = oldest->pass;
        _entries.erase(oldest);
        const auto itsFrame = [&](const CameraFrame& frame)
        { return sameCamera(frame.pass, gone); };
        const auto its = [&](const Entry& entry) { return sameCamera(entry.pass, gone); };
        if (std::none_of(_entries.begin(), _entries.end(), its) && !sameCamera(gone, pass))
            _frames.erase(std::remove_if(_frames.begin(), _frames.end(), itsFrame), _frames.end());
    }

    void expire()
    {
        OSGRAYTRACE_ASSERT(_mutex.isHeld());
        const auto old = [this](const auto& item) { return item.round + kExpiry < _round; };
        _entries.erase(std::remove_if(_entries.begin(), _entries.end(), old), _entries.end());
        _frames.erase(std::remove_if(_frames.begin(), _frames.end(), old), _frames.end());
    }

    mutable CheckedMutex
        _mutex; // draw, cull and releaseGLObjects lock it, on any thread; it guards all below
    std::vector<Entry> _entries;
    std::vector<CameraFrame> _frames;
    std::vector<PassIdentity> _recorded; ///< the last pass of each stage
    uint64_t _round = 0;
};

} // namespace osgRayTrace::engine
