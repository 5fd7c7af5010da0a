// BackgroundTracer.cpp - traces a view on a thread of its own, for draw to take the newest image.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/view/BackgroundTracer.h"

#include "osgRayTrace/bridge/view/BackgroundThreads.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <new>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Whether the image of one is as good for the other. Settings are copied when they change, and not
/// before.
bool same(const TraceRequest& a, const TraceRequest& b)
{
    return a.version.scene == b.version.scene && a.version.workers == b.version.workers &&
           a.version.photons == b.version.photons && a.version.settings == b.version.settings &&
           sameButForRounding(a.view, b.view) && a.slices.size() == b.slices.size() &&
           a.budget.seconds == b.budget.seconds && a.budget.degrade == b.budget.degrade &&
           a.traces == b.traces;
}

/// Without the parts of the scene graph that draw and cull have it for: the worker may be the last
/// to let go of a request.
TraceRequest withoutGraph(TraceRequest request)
{
    request.version.rasterized.reset();
    request.version.pickIndex.reset();
    return request;
}

void makeRoom(TracedImage& image, int width, int height)
{
    if (image.color && image.color->s() == width && image.color->t() == height) return;
    image = TracedImage(); // until both are there
    osg::ref_ptr<osg::Image> color = new osg::Image;
    osg::ref_ptr<osg::Image> depth = new osg::Image;
    color->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    depth->allocateImage(width, height, 1, GL_LUMINANCE, GL_FLOAT);
    image.color = color;
    image.depth = depth;
}

/// Of a step of the worker.
struct Outcome
{
    RenderProgress progress;
    FrameReport frame;
    bool done = true; ///< nothing is left to do for its request, or nothing can be done
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

    std::mutex
        tracing; // who traces: the worker; draw of a frame-locked view; who asks for radiance
    ViewTracer tracer;
    bool stepping = false; ///< the worker traces, and no one else
    TracedImage result;    ///< that the worker writes

    std::mutex mutex;             // draw, the worker and those with a Lease; all below
    std::condition_variable wake; ///< the worker
    std::shared_ptr<const TraceRequest> wanted; ///< null: nothing yet
    uint64_t number = 0;     ///< of that; it grows with each that differs, or is tried again
    uint64_t askedAt = 0;    ///< frame that wanted it last
    bool due = false;        ///< there is something to do, or may be
    bool failed = false;     ///< the last step did; nobody has asked since
    int unasked = 0;         ///< steps since a frame asked
    int guests = 0;          ///< who have a Lease, or wait for one
    bool running = false;    ///< there is a thread
    bool stops = false;      ///< it shall end, unless somebody asks before it does
    bool ended = false;      ///< the process ends: it shall end whoever asks
    bool working = false;    ///< it is in a step
    uint64_t taken = 0;      ///< number of the request that the worker is at
    bool handedOver = false; ///< an image of that
    std::atomic<bool> outdated{false}; ///< the step is to be given up; read without the mutex
    TracedImage newest;                ///< if fresh; else one that draw is done with
    bool fresh = false;
    TraceReport report;
    uint64_t reportOf = 0;   ///< number of its request
    uint64_t forgotten = 0;  ///< failures up to this number
    uint64_t reported = 0;   ///< number of the newest image's request
    uint64_t reportedAt = 0; ///< frame that wanted it when its step began
};

/// True if a thread has to be started.
bool BackgroundTracer::Worker::ask(const TraceRequest& request, uint64_t frame)
{
    std::shared_ptr<const TraceRequest> old; // freed without the lock
    bool starts = false;
    {
        std::lock_guard<std::mutex> lock(mutex);
        if (ended) return false;
        const bool differs = !wanted || !same(*wanted, request);
        if (differs)
            old = std::exchange(wanted, std::make_shared<TraceRequest>(withoutGraph(request)));
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

/// When the process ends: other threads may draw, and so ask, until the very end of it.
void BackgroundTracer::Worker::end()
{
    {
        std::lock_guard<std::mutex> lock(mutex);
        ended = true;
    }
    stop();
}

/// On the worker's thread.
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
        const std::weak_ptr<const TracedScene> scene = request->version.scene;
        request.reset(); // it may be the last to hold its scene
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
    std::lock_guard<std::mutex> lock(tracing);
    stepping = true;
    Outcome outcome = tryToTrace(request);
    stepping = false;
    return outcome;
}

/// Draw catches the same: see RayTraceDrawable.
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
    if (request.traces) tracer.trace(request.version, request.view, request.budget);
    // What was given up may wait: an image of its request is there, and another one is wanted.
    if (tracer.needsResolve(request.version) && !outdated)
    {
        makeRoom(result, tracer.displayWidth(), tracer.displayHeight());
        result.slices = request.slices;
        tracer.resolve(result.color->data(), reinterpret_cast<float*>(result.depth->data()));
        handOver();
    }
    if (request.traces) tracer.recordPresented();
    Outcome outcome{tracer.progress(), tracer.frame(), true};
    if (outcome.progress.status.ok()) outcome.done = !request.traces || tracer.isDone();
    return outcome;
}

void BackgroundTracer::Worker::handOver()
{
    std::lock_guard<std::mutex> lock(mutex);
    if (stops) return tracer.forgetDisplay();
    std::swap(result, newest);
    fresh = handedOver = true;
    // Whatever else is wanted by now need not wait for more of this.
    outdated = number != taken;
}

BackgroundTracer::BackgroundTracer(std::function<double()> now)
    : _worker(std::make_shared<Worker>(std::move(now)))
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
        started = startBackgroundThread([worker = _worker] { worker->run(); }, stop);
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
    return &_worker.tracer;
}

} // namespace osgRayTrace::engine
