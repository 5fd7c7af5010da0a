// BackgroundTracer.cpp - traces a view on a thread, for draw to take the newest image. Layer:
// session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/BackgroundTracer.h"

#include "osgRayTrace/base/CheckedMutex.h"
#include "osgRayTrace/session/view/BackgroundThreads.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <new>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Returns true if the image of one request is as good for the other.
bool same(const TraceRequest& a, const TraceRequest& b)
{
    return sameImage(a.inputs, b.inputs) && sameButForRounding(a.view, b.view) &&
           a.slices.size() == b.slices.size() && a.budget.seconds == b.budget.seconds &&
           a.budget.degrade == b.budget.degrade && a.traces == b.traces;
}

void makeRoom(TracedImage& image, int width, int height)
{
    if (image.pixels && image.pixels->width == width && image.pixels->height == height) return;
    image = TracedImage(); // the old pixels are freed before new ones are made
    image.pixels = std::make_shared<TracedPixels>(width, height);
}

/// The outcome of a step of the worker.
struct Outcome
{
    ViewProgress progress;
    FrameReport frame;
    bool done = true; ///< nothing is left to do for the request, or nothing can be done
};

Outcome failedOutcome(StatusCode code, const char* message) noexcept
{
    Outcome outcome;
    outcome.progress.status = failure(code, message);
    return outcome;
}

} // namespace

struct BackgroundTracer::Worker
{
    explicit Worker(std::function<double()> now) : tracer(std::move(now))
    {
        tracer.setInterrupt([this]
                            { return stepping && outdated.load(std::memory_order_relaxed); });
    }

    bool ask(const TraceRequest& request, uint64_t frame);
    void stop();
    void end();
    void run() noexcept;
    Outcome step(const TraceRequest& request) noexcept;
    Outcome tryToTrace(const TraceRequest& request) noexcept;
    Outcome traceAndResolve(const TraceRequest& request);
    void handOver();
    bool mayStep() const { return due && guests == 0 && unasked < kMostUnasked; }

    CheckedMutex
        tracing; // held while tracing or reading: by the worker, by draw, by a request for radiance
    ViewTracer tracer;
    bool stepping = false; ///< whether the worker traces
    TracedImage result;    ///< the image that the worker writes

    std::mutex mutex; // draw, the worker and leases lock it; it guards all members below
    std::condition_variable wake;               ///< wakes the worker
    std::shared_ptr<const TraceRequest> wanted; ///< the request; null: nothing was asked for yet
    uint64_t number = 0;     ///< counts the requests that differ or are tried again
    uint64_t askedAt = 0;    ///< the last frame that asked
    bool due = false;        ///< whether there is something to do, or may be
    bool failed = false;     ///< whether the last step failed and nobody has asked since
    int unasked = 0;         ///< steps since a frame asked
    int guests = 0;          ///< leases, and those who wait for one
    bool running = false;    ///< whether there is a thread
    bool stops = false;      ///< whether the thread shall end, unless somebody asks before it does
    bool ended = false;      ///< whether the process ends: the thread shall end whoever asks
    bool working = false;    ///< whether the thread is in a step
    uint64_t taken = 0;      ///< number of the request that the worker is at
    bool handedOver = false; ///< whether an image of the taken request was handed over
    std::atomic<bool> outdated{
        false};         ///< whether the step is to be given up; read without the mutex
    TracedImage newest; ///< the newest image if fresh; otherwise a used one
    bool fresh = false;
    TraceReport report;
    uint64_t reportOf = 0;   ///< number of the request that report is about
    uint64_t forgotten = 0;  ///< failures of requests up to this number do not count
    uint64_t reported = 0;   ///< number of the newest image's request
    uint64_t reportedAt = 0; ///< the last frame that had asked for it when its step began
};

/// Takes the request. Returns true if a thread has to be started.
bool BackgroundTracer::Worker::ask(const TraceRequest& request, uint64_t frame)
{
    std::shared_ptr<const TraceRequest> old; // freed without the lock
    bool starts = false;
    {
        std::lock_guard<std::mutex> lock(mutex);
        if (ended) return false;
        const bool differs = !wanted || !same(*wanted, request);
        if (differs) old = std::exchange(wanted, std::make_shared<TraceRequest>(request));
        if (differs) outdated = handedOver;
        if (differs || failed) ++number;
        starts = !running;
        due |= differs || failed || starts || stops;
        failed = false;
        running = true;
        stops = false;
        askedAt = frame;
        unasked = 0;
    }
    wake.notify_one();
    return starts;
}

void BackgroundTracer::Worker::stop()
{
    {
        std::lock_guard<std::mutex> lock(mutex);
        stops = outdated = true;
        fresh = false;
    }
    wake.notify_one();
}

/// Ends the worker for good when the process ends: until its very end other threads may draw, and
/// so ask.
void BackgroundTracer::Worker::end()
{
    {
        std::lock_guard<std::mutex> lock(mutex);
        ended = true;
    }
    stop();
}

/// Works until the worker is to end. The worker's thread runs it.
void BackgroundTracer::Worker::run() noexcept
{
    std::unique_lock<std::mutex> lock(mutex);
    while (true)
    {
        wake.wait(lock, [this] { return stops || mayStep(); });
        if (stops) break;
        if (taken != number) handedOver = false;
        taken = number;
        std::shared_ptr<const TraceRequest> request = wanted;
        const uint64_t at = askedAt;
        due = outdated = false;
        working = true;
        ++unasked;

        lock.unlock();
        Outcome outcome = step(*request);
        const std::weak_ptr<const TracedScene> scene = request->inputs.scene;
        request.reset(); // the request may be the last to hold its scene
        lock.lock();

        working = false;
        due |= !outcome.done;
        const bool ok = outcome.progress.status.ok();
        failed = !ok && taken == number;
        report = {std::move(outcome.progress), outcome.frame, scene, true, 0};
        reportOf = taken;
        if (!ok) continue;
        reported = taken;
        reportedAt = at;
    }
    running = false;
}

Outcome BackgroundTracer::Worker::step(const TraceRequest& request) noexcept
{
    std::lock_guard<CheckedMutex> lock(tracing);
    stepping = true;
    Outcome outcome = tryToTrace(request);
    stepping = false;
    return outcome;
}

/// Traces a step of the request, and catches what RayTraceDrawable catches of draw.
Outcome BackgroundTracer::Worker::tryToTrace(const TraceRequest& request) noexcept
{
    try
    {
        return traceAndResolve(request);
    }
    catch (const std::bad_alloc&)
    {
        tracer.forgetDisplay();
        return failedOutcome(StatusCode::OutOfMemory, "there is not enough memory for a view");
    }
    catch (const std::exception& error)
    {
        tracer.forgetDisplay();
        return failedOutcome(StatusCode::DeviceFailure, error.what());
    }
    catch (...)
    {
        tracer.forgetDisplay();
        return failedOutcome(StatusCode::DeviceFailure, "a view could not be traced");
    }
}

Outcome BackgroundTracer::Worker::traceAndResolve(const TraceRequest& request)
{
    OSGRAYTRACE_ASSERT(tracing.isHeld());
    if (request.traces) tracer.trace(request.inputs, request.view, request.budget);
    // A pass that was given up need not be shown: the pass's request has an image, and another is
    // wanted.
    if (tracer.needsResolve(request.inputs) && !outdated)
    {
        makeRoom(result, tracer.displayWidth(), tracer.displayHeight());
        result.slices = request.slices;
        tracer.resolve(result.pixels->rgba.data(), result.pixels->depth.data());
        handOver();
    }
    if (request.traces) tracer.recordPresented();
    Outcome outcome{tracer.progress(), tracer.frame(), true};
    if (outcome.progress.status.ok())
        outcome.done = !request.traces || (tracer.isDone() && !tracer.isExposureMoving());
    return outcome;
}

void BackgroundTracer::Worker::handOver()
{
    std::lock_guard<std::mutex> lock(mutex);
    if (stops) return tracer.forgetDisplay();
    std::swap(result, newest);
    fresh = handedOver = true;
    // If another request came meanwhile, that request need not wait for more passes of this one.
    outdated = number != taken;
}

TracedPixels::TracedPixels(int w, int h)
    : width(w),
      height(h),
      rgba(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
      depth(static_cast<std::size_t>(w) * static_cast<std::size_t>(h))
{
}

BackgroundTracer::BackgroundTracer(std::function<double()> now, std::function<void()> prepareThread)
    : _worker(std::make_shared<Worker>(std::move(now))), _prepareThread(std::move(prepareThread))
{
}

BackgroundTracer::~BackgroundTracer()
{
    _worker->stop();
}

void BackgroundTracer::ask(const TraceRequest& request, uint64_t frame)
{
    if (!_worker->ask(request, frame)) return;
    bool started = false;
    const auto recordFailure = [&]
    {
        if (started) return;
        std::lock_guard<std::mutex> lock(_worker->mutex);
        _worker->running = false;
    };
    try
    {
        const std::weak_ptr<Worker> weak = _worker;
        const auto stop = [weak]
        {
            if (const std::shared_ptr<Worker> worker = weak.lock()) worker->end();
        };
        started = startBackgroundThread(
            [worker = _worker, prepare = _prepareThread]
            {
                if (prepare) prepare();
                worker->run();
            },
            stop);
        recordFailure();
    }
    catch (...)
    {
        recordFailure();
        throw;
    }
}

bool BackgroundTracer::takeNewest(TracedImage& shown)
{
    std::lock_guard<std::mutex> lock(_worker->mutex);
    if (!_worker->fresh) return false;
    std::swap(shown, _worker->newest);
    _worker->fresh = false;
    return true;
}

TraceReport BackgroundTracer::report(uint64_t frame)
{
    Worker& worker = *_worker;
    std::lock_guard<std::mutex> lock(worker.mutex);
    TraceReport report = worker.report;
    report.fresh &= worker.reportOf > worker.forgotten;
    worker.report.fresh = false;
    if (worker.reported > 0 && worker.reported != worker.number)
        report.age = static_cast<int>(frame - worker.reportedAt);
    return report;
}

void BackgroundTracer::forgetFailures()
{
    std::lock_guard<std::mutex> lock(_worker->mutex);
    _worker->forgotten = _worker->number;
}

void BackgroundTracer::stop()
{
    _worker->stop();
}

void BackgroundTracer::forget()
{
    stop();
    std::shared_ptr<const TraceRequest> wanted; // freed without the lock
    TracedImage newest;
    {
        std::lock_guard<std::mutex> lock(_worker->mutex);
        wanted.swap(_worker->wanted);
        std::swap(newest, _worker->newest);
        _worker->report = TraceReport();
    }
    lease()->forget();
}

bool BackgroundTracer::isWorking() const
{
    std::lock_guard<std::mutex> lock(_worker->mutex);
    return _worker->running && (_worker->working || _worker->stops || _worker->mayStep());
}

BackgroundTracer::Lease::Lease(Worker& worker) : _worker(worker)
{
    {
        std::lock_guard<std::mutex> lock(_worker.mutex);
        ++_worker.guests;
    }
    _worker.tracing.lock();
}

BackgroundTracer::Lease::~Lease()
{
    _worker.tracing.unlock();
    {
        std::lock_guard<std::mutex> lock(_worker.mutex);
        --_worker.guests;
    }
    _worker.wake.notify_one();
}

ViewTracer* BackgroundTracer::Lease::operator->() const
{
    OSGRAYTRACE_ASSERT(_worker.tracing.isHeld());
    return &_worker.tracer;
}

} // namespace osgRayTrace::engine
