// BackgroundTracer.h - traces a view on a thread of its own, for draw to take the newest image.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace osgRayTrace::engine
{

/// The image that a frame wants to show.
struct TraceRequest
{
    ViewInputs inputs; ///< with a scene
    View view;
    std::vector<View> slices; ///< the views of the passes that the traced view is for
    FrameBudget budget;
    bool traces = true; ///< false: the image gets no samples, and may be shown differently
};

/// Pixels for the display, as ViewTracer::resolve() writes them: rows from the bottom.
struct TracedPixels
{
    TracedPixels(int w, int h);

    int width, height;
    UnclearedArray<uint8_t> rgba; ///< width * height * 4 values
    UnclearedArray<float> depth;  ///< width * height values
};

/// An image for the display, all of which is of one view.
struct TracedImage
{
    /// Null: there is none yet. Whoever shows the pixels may keep them longer than the image.
    std::shared_ptr<TracedPixels> pixels;
    std::vector<View> slices; ///< those of its request
};

/// The outcome of the last step of the worker.
struct TraceReport
{
    ViewProgress progress;
    FrameReport frame;
    std::weak_ptr<const TracedScene> scene;
    bool fresh = false; ///< there was a step since the report before
    /// Frames since the view of the newest image was asked for; 0: that view is the present one.
    int age = 0;
};

/// A ViewTracer and the thread that works with it while images are asked for.
///
/// The worker takes the newest request, traces what its budget has time for, hands the image over,
/// and so on until the image is done; then it sleeps until another request comes. A request that
/// differs makes the worker give up the pass at work, unless it has not handed over any image of
/// its present request yet. So a view that moves in every frame has images all the same, each of
/// one view and complete. If nobody asks any more, the worker rests after kMostUnasked steps.
///
/// Locks: Worker::mutex guards requests and the image that is handed over, and is held for moments
/// only. Worker::tracing guards the tracer, and is held while it traces: by the worker, or by
/// whoever has a Lease. Whoever wants both takes tracing first. Of the three images the worker
/// writes one, draw shows another, and the third changes hands under mutex. The destructor does not
/// wait for the worker, which gives up within a tile (or when the photons of its pass are traced)
/// and keeps what it needs until then alive.
class BackgroundTracer
{
public:
    static constexpr int kMostUnasked = 64;

    /// now: a clock [s], for tests. prepareThread: called by each thread that works for the view
    /// before it does so.
    explicit BackgroundTracer(std::function<double()> now = {},
                              std::function<void()> prepareThread = {});
    ~BackgroundTracer();
    BackgroundTracer(const BackgroundTracer&) = delete;
    BackgroundTracer& operator=(const BackgroundTracer&) = delete;

    /// Asks for images of the request from now on; frame is a number that grows from frame to
    /// frame. Starts the worker if there is none, and never waits for it. Draw thread of the view.
    void ask(const TraceRequest& request, uint64_t frame);

    /// Exchanges shown, whose pixels the caller reads no more, for a newer image. False if there is
    /// none. Never waits. Draw thread of the view.
    bool takeNewest(TracedImage& shown);

    /// The report of the worker's last step. Never waits. Draw thread of the view.
    TraceReport report(uint64_t frame);

    /// Reports of requests until now are not fresh: what failed is to be tried again. Any thread.
    void forgetFailures();

    /// Makes the worker give up what it does, and end; images that were not taken are dropped. Does
    /// not wait.
    void stop();

    /// True unless the worker sleeps or has ended. Any thread.
    bool isWorking() const;

private:
    struct Worker;

public:
    /// While a lease lives, its owner uses the tracer, and the worker does not.
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
    std::shared_ptr<Worker> _worker; ///< shared with its thread
    std::function<void()> _prepareThread;
};

} // namespace osgRayTrace::engine
