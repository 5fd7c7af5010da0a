// ViewRegistry.h - which state belongs to the pass that draws now. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace osgRayTrace::engine
{

/// One pass over a scene. The pointers are names, never followed: an address that is used again at
/// most continues with a state that is then restarted.
struct PassIdentity
{
    const void* camera = nullptr;
    const void* renderStage = nullptr; ///< one for each eye; viewers may alternate two sets
    unsigned int contextId = 0;
    uint64_t frameNumber = 0;      ///< of the camera's viewer
    std::array<int, 4> viewport{}; ///< x, y, width, height
};

/// The states of all views, found again frame after frame.
///
/// A view is a camera, a context and an eye, and the viewport where one pass draws several. The eye
/// is the place of the render stage among those that draw for the camera in this frame: neither
/// matrices nor traversal masks nor cull visitors tell eyes apart in all of OSG's and its
/// frameworks' stereo modes. A view whose viewport changes (a window is resized) keeps its state.
/// What was not drawn for kExpiry rounds is forgotten; a round ends when some view draws for the
/// second time.
///
/// Thread safe; the states are shared, and may outlive their entry while a draw thread uses them.
template <class State> class ViewRegistry
{
public:
    static constexpr uint64_t kExpiry = 120; ///< rounds

    /// The state of the pass, made by make() for a new view. Draw threads.
    template <class Make> std::shared_ptr<State> acquire(const PassIdentity& pass, Make make)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const std::size_t eye = eyeOf(pass);
        Entry* entry = find(pass, eye);
        if (!entry)
        {
            _entries.push_back({pass, eye, _round, make()});
            entry = &_entries.back();
        }
        else if (entry->round == _round)
        {
            ++_round;
        }
        entry->pass = pass;
        entry->round = _round;
        std::shared_ptr<State> state = entry->state;
        expire();
        return state;
    }

    /// All states there are now. Any thread.
    std::vector<std::shared_ptr<State>> states() const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        std::vector<std::shared_ptr<State>> result;
        for (const Entry& entry : _entries)
            result.push_back(entry.state);
        return result;
    }

private:
    struct Entry
    {
        PassIdentity pass; ///< the last one
        std::size_t eye;
        uint64_t round;
        std::shared_ptr<State> state;
    };

    /// The stages that drew for a camera in its frame, in order.
    struct CameraFrame
    {
        PassIdentity pass;
        uint64_t round;
        std::vector<const void*> stages;
    };

    static bool sameCamera(const PassIdentity& a, const PassIdentity& b)
    {
        return a.camera == b.camera && a.contextId == b.contextId;
    }

    std::size_t eyeOf(const PassIdentity& pass)
    {
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

    /// The view itself; or one of the same eye that did not draw in this frame, whose viewport
    /// changed.
    Entry* find(const PassIdentity& pass, std::size_t eye)
    {
        Entry* moved = nullptr;
        for (Entry& entry : _entries)
        {
            if (!sameCamera(entry.pass, pass) || entry.eye != eye) continue;
            if (entry.pass.viewport == pass.viewport) return &entry;
            if (entry.pass.frameNumber != pass.frameNumber) moved = &entry;
        }
        return moved;
    }

    void expire()
    {
        const auto old = [this](const auto& item) { return item.round + kExpiry < _round; };
        _entries.erase(std::remove_if(_entries.begin(), _entries.end(), old), _entries.end());
        _frames.erase(std::remove_if(_frames.begin(), _frames.end(), old), _frames.end());
    }

    mutable std::mutex _mutex; // draw threads; and releaseGLObjects, from any thread
    std::vector<Entry> _entries;
    std::vector<CameraFrame> _frames;
    uint64_t _round = 0;
};

} // namespace osgRayTrace::engine
