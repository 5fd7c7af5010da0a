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
    ViewInputs inputs; ///< inputs that have a scene
    View view;
    std::vector<View> slices; ///< the views of the passes that the traced view is for
    FrameBudget budget;
    bool traces = true; ///< false: the image gets no samples, and may be shown differently
};

/// Pixels for the display, as ViewTracer::resolve() writes them: the rows begin at the bottom.
struct TracedPixels
{
    TracedPixels(int w, int h);

    int width, height;
    UnclearedArray<uint8_t> rgba; ///< width * height * 4 values
    UnclearedArray<float> depth;  ///< width * height values
};

/// An image for the display. All its pixels are of one view.
struct TracedImage
{
    /// The pixels, null if there is no image yet. Whoever shows the pixels may keep them longer
    /// than the image.
    std::shared_ptr<TracedPixels> pixels;
    std::vector<View> slices; ///< the slices of the image's request
};

/// The outcome of the last step of the worker.
struct TraceReport
{
    ViewProgress progress;
    FrameReport frame;
    std::weak_ptr<const TracedScene> scene;
    bool fresh = false; ///< whether a step was made since the report before
    /// Frames since the view of the newest image was asked for. The age is 0 if that view is the
    /// present one.
    int age = 0;
};

/// A ViewTracer and the thread that works with the tracer while images are asked for.
///
/// The worker takes the newest request, traces what the request's budget has time for, hands the
/// image over, and so on until the image is done; then the worker sleeps until another request
/// comes. A request that differs makes the worker give up the pass at work, unless no image of the
/// present request has been handed over yet. So a view that moves in every frame has images all the
/// same, each of one view and complete. If nobody asks any more, the worker rests after
/// kMostUnasked steps.
///
/// Worker::mutex guards requests and the image that is handed over, and is held for moments only.
/// Worker::tracing guards the tracer, and is held while the tracer works: by the worker, or by
/// whoever has a Lease. Whoever wants both locks takes Worker::tracing first. Of the three images
/// the worker writes one, draw shows another, and the third changes hands under Worker::mutex. The
/// destructor does not wait for the worker, which gives up within a tile (or when the photons of
/// its pass are traced) and keeps what it needs until then alive.
class BackgroundTracer
{
public:
    static constexpr int kMostUnasked = 64;

    /// Makes a tracer without a thread. now is a clock [s], which tests replace. Each thread that
    /// works for the view calls prepareThread first.
    explicit BackgroundTracer(std::function<double()> now = {},
                              std::function<void()> prepareThread = {});
    ~BackgroundTracer();
    BackgroundTracer(const BackgroundTracer&) = delete;
    BackgroundTracer& operator=(const BackgroundTracer&) = delete;

    /// Asks for images of the request from now on; frame is a number that grows from frame to
    /// frame. Starts the worker if none runs, and never waits for the worker. The view's draw
    /// thread calls it.
    void ask(const TraceRequest& request, uint64_t frame);

    /// Exchanges shown, whose pixels the caller reads no more, for a newer image. Returns false if
    /// there is no newer image. Never waits. The view's draw thread calls it.
    bool takeNewest(TracedImage& shown);

    /// Returns the report of the worker's last step. Never waits. The view's draw thread calls it.
    TraceReport report(uint64_t frame);

    /// Makes reports of requests until now count as not fresh, so that what failed is tried again.
    /// Any thread may call it.
    void forgetFailures();

    /// Makes the worker give up its work and end; images that were not taken are dropped. Does not
    /// wait.
    void stop();

    /// Stops, and lets go of the tracer's image and of all requests with their scenes, as soon as
    /// the worker has ended its step. The view's draw thread calls it.
    void forget();

    /// Returns true unless the worker sleeps or has ended. Any thread may call it.
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

    /// Returns a lease as soon as the worker has ended its step. Any thread may call it.
    Lease lease() const { return Lease(*_worker); }

private:
    std::shared_ptr<Worker> _worker; ///< shared with its thread
    std::function<void()> _prepareThread;
};

} // namespace osgRayTrace::engine
