// BackgroundTracer.h - traces a view on a thread of its own, for draw to take the newest image.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/view/ViewTracer.h"

#include <osg/Image>
#include <osg/ref_ptr>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace osgRayTrace::engine
{

/// What a frame wants to show.
struct TraceRequest
{
    SceneVersion version; ///< with a scene
    View view;
    std::vector<View> slices; ///< of the passes that the view is for
    FrameBudget budget;
    bool traces = true; ///< false: the image stays what it is, but for how it is shown
};

/// For the display: rows from the bottom, as ViewTracer::resolve() writes them. All of it is of one
/// view.
struct TracedImage
{
    osg::ref_ptr<osg::Image> color; ///< null: none yet
    osg::ref_ptr<osg::Image> depth;
    std::vector<View> slices; ///< of its request
};

/// Of the last step of the worker.
struct TraceReport
{
    RenderProgress progress;
    FrameReport frame;
    std::weak_ptr<const TracedScene> scene;
    bool fresh = false; ///< there was a step since the report before
    int age =
        0; ///< of the newest image: frames since its view was asked for; 0: it is the present one
};

/// A ViewTracer and the thread that works with it while images are asked for.
///
/// The worker takes the newest request, traces what its budget has time for, hands the image over,
/// and so on until the image is done; then it sleeps until another request comes. A request that
/// differs makes it give up the pass at work, unless it has not handed over any image of its
/// present request yet: so a view that moves in every frame has images all the same, each of one
/// view, complete. If nobody asks any more it rests after kMostUnasked steps.
///
/// Locks: _mutex guards requests and the image that is handed over, and is held for moments only.
/// _tracing guards the tracer, and is held while it traces: by the worker, or by who has a Lease.
/// Who wants both takes _tracing first. Of the three images the worker writes one, draw shows
/// another, and the third changes hands under _mutex. Destroyed, it does not wait for the worker,
/// which gives up within a tile (or when the photons of its pass are traced) and takes what it
/// needs until then with it.
class BackgroundTracer
{
public:
    static constexpr int kMostUnasked = 64;

    /// now: a clock [s], for tests.
    explicit BackgroundTracer(std::function<double()> now = {});
    ~BackgroundTracer();
    BackgroundTracer(const BackgroundTracer&) = delete;
    BackgroundTracer& operator=(const BackgroundTracer&) = delete;

    /// Wants an image of this from now on; frame: a number that grows from frame to frame. Starts
    /// the worker if there is none. Never waits for it. Draw thread of the view.
    void ask(const TraceRequest& request, uint64_t frame);

    /// Exchanges shown, which the caller is done with, for a newer image. False if there is none.
    /// Never waits. Draw thread of the view.
    bool takeNewest(TracedImage& shown);

    /// Of the worker's last step. Never waits. Draw thread of the view.
    TraceReport report(uint64_t frame);

    /// Reports of what was asked for until now are not fresh: it is to be tried again. Any thread.
    void forgetFailures();

    /// The worker gives up what it does, and ends; images that were not taken are dropped. Does not
    /// wait.
    void stop();

    /// True unless the worker sleeps or has ended. Any thread.
    bool isWorking() const;

private:
    struct Worker;

public:
    /// The tracer for one's own use while it lives.
    class Lease
    {
    public:
        ~Lease();
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        ViewTracer* operator->() const;

    private:
        friend class BackgroundTracer;
        explicit Lease(Worker& worker);
        Worker& _worker;
    };

    /// Waits until the worker ends its step. Any thread.
    Lease lease() const { return Lease(*_worker); }

private:
    std::shared_ptr<Worker> _worker; ///< its thread's, too
};

} // namespace osgRayTrace::engine
