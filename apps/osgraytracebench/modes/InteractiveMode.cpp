// InteractiveMode.cpp - moves a camera under frame budgets. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/InteractiveMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"
#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/base/SteadySeconds.h"
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <glm/gtc/matrix_transform.hpp>

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <vector>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr double kBudgets[] = {16.0, 33.0, 100.0}; // [ms]

/// Holds a picture, and the copy of its changed parts that a driver takes.
struct Picture
{
    int width = 0, height = 0;
    UnclearedArray<uint8_t> rgba, copiedRgba;
    UnclearedArray<float> depth, copiedDepth;

    void resize(int w, int h)
    {
        if (w == width && h == height) return;
        width = w;
        height = h;
        const std::size_t pixels = std::size_t(w) * std::size_t(h);
        rgba = UnclearedArray<uint8_t>(4 * pixels);
        copiedRgba = UnclearedArray<uint8_t>(4 * pixels);
        depth = UnclearedArray<float>(pixels);
        copiedDepth = UnclearedArray<float>(pixels);
    }

    /// Reserves memory as DisplayTexture::reserve() does; the copies stand for a driver's.
    void reserve(int w, int h)
    {
        if (width > 0) return;
        resize(w, h);
        const std::size_t pixels = std::size_t(w) * std::size_t(h);
        for (uint8_t* values : {rgba.data(), copiedRgba.data()})
            std::memset(values, 0, 4 * pixels);
        for (float* values : {depth.data(), copiedDepth.data()})
            std::memset(values, 0, pixels * sizeof(float));
    }

    template <class T>
    void copy(const std::vector<uint8_t>& marks, const T* from, T* to, std::size_t values) const
    {
        for (const PixelRect& rect : changedRects(marks, width, height))
            for (int y = rect.y; y < rect.y + rect.height; ++y)
            {
                const std::size_t first =
                    values * (std::size_t(y) * std::size_t(width) + std::size_t(rect.x));
                std::memcpy(to + first, from + first, values * sizeof(T) * std::size_t(rect.width));
            }
    }

    void upload(const ChangedTiles& changed)
    {
        copy(changed.color, rgba.data(), copiedRgba.data(), 4);
        copy(changed.depth, depth.data(), copiedDepth.data(), 1);
    }

    void uploadAll()
    {
        std::memcpy(copiedRgba.data(), rgba.data(), rgba.size());
        std::memcpy(copiedDepth.data(), depth.data(), depth.size() * sizeof(float));
    }
};

/// Does all that a viewer's frame does with a view, without OpenGL.
struct Display
{
    Picture full, reduced;
    Picture* shown = &full;

    void frame(ViewTracer& tracer, const ViewInputs& inputs, const View& view,
               const FrameBudget& budget)
    {
        const bool fits = shown->width == view.width && shown->height == view.height;
        const bool written = tracer.trace(inputs, view, budget, fits ? shown->rgba.data() : nullptr,
                                          fits ? shown->depth.data() : nullptr);
        if (tracer.needsResolve(inputs))
        {
            const int width = tracer.displayWidth(), height = tracer.displayHeight();
            shown = width == view.width && height == view.height ? &full : &reduced;
            shown->resize(width, height);
            full.reserve(view.width, view.height);
            tracer.resolve(shown->rgba.data(), shown->depth.data());
            shown->uploadAll();
        }
        else if (written)
        {
            shown->upload(tracer.changed());
        }
        tracer.recordPresented();
    }
};

using Clock = std::function<double()>;

/// Returns the clock [s] of the options.
Clock clockOf(const InteractiveOptions& options, int threads)
{
    if (!options.cpuClock) return steadySeconds;
    return [threads]
    {
        timespec time;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return (double(time.tv_sec) + 1e-9 * double(time.tv_nsec)) / threads;
    };
}

double secondsBy(const Clock& clock, const std::function<void()>& body)
{
    const double begin = clock();
    body();
    return clock() - begin;
}

/// Returns the view, turned a little.
View turned(View view, double yaw, double pitch)
{
    const Mat4d turn =
        glm::rotate(glm::rotate(Mat4d(1.0), yaw, Vec3d(0, 1, 0)), pitch, Vec3d(1, 0, 0));
    view.viewFromWorld = turn * view.viewFromWorld;
    return view;
}

struct Frame
{
    double seconds, traceSeconds;
    int divider;
    bool moving;
};

struct Trip
{
    std::vector<Frame> frames; ///< without the first image and those after jumps
    double first = 0.0;        ///< time of the first image [s]
    std::vector<double> jumps; ///< time of the image after each jump [s]
};

/// Moves, stops and jumps, several times.
Trip travel(const ViewInputs& inputs, const View& view, double budgetSeconds, const Clock& clock)
{
    constexpr int kLegs = 4, kMoving = 25, kStill = 12;
    ViewTracer tracer(clock);
    Display display;
    Trip trip;
    double time = 0.0, jump = 0.0;
    const auto frame = [&](bool moving)
    {
        display.frame(tracer, inputs,
                      turned(view, jump + 0.2 * std::sin(time), 0.08 * std::sin(1.7 * time)),
                      {budgetSeconds, true});
        return Frame{tracer.frame().seconds, tracer.frame().traceSeconds, tracer.frame().divider,
                     moving};
    };
    trip.first = frame(true).seconds;
    for (int leg = 0; leg < kLegs; ++leg)
    {
        for (int i = 0; i < kMoving; ++i)
        {
            time += 0.05;
            trip.frames.push_back(frame(true));
        }
        for (int i = 0; i < kStill; ++i)
            trip.frames.push_back(frame(false));
        jump = 0.3 * (leg % 2 ? 1.0 : -1.0);
        trip.jumps.push_back(frame(true).seconds);
    }
    return trip;
}

double percentile(std::vector<double> values, double share)
{
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * double(values.size() - 1))];
}

void addTrip(Rows& rows, const std::string& name, const Trip& trip, double budget)
{
    std::vector<double> shares, besides[2];
    double traced = 0.0;
    int inTime = 0, largest = 1;
    for (const Frame& frame : trip.frames)
    {
        shares.push_back(frame.seconds / budget);
        traced += frame.traceSeconds / budget;
        besides[frame.moving].push_back((frame.seconds - frame.traceSeconds) / budget);
        inTime += frame.seconds <= 1.1 * budget;
        largest = std::max(largest, frame.divider);
    }
    const double frames = double(trip.frames.size());
    rows.push_back(
        {name + ": frames within 110 %", 100.0 * inTime / frames, "%", Goal::AtLeast, 95.0});
    rows.push_back({name + ": frame, median", 100.0 * median(shares), "% of the budget"});
    rows.push_back(
        {name + ": frame, 95th percentile", 100.0 * percentile(shares, 0.95), "% of the budget"});
    rows.push_back({name + ": frame, worst", 100.0 * percentile(shares, 1.0), "% of the budget",
                    Goal::AtMost, 200.0});
    rows.push_back({name + ": spent tracing", 100.0 * traced / frames, "% of the budget",
                    Goal::AtLeast, 30.0});
    rows.push_back({name + ": image after a jump, worst",
                    100.0 * percentile(trip.jumps, 1.0) / budget, "% of the budget", Goal::AtMost,
                    110.0});
    rows.push_back({name + ": first image of all", 100.0 * trip.first / budget, "% of the budget"});
    rows.push_back(
        {name + ": besides tracing, moving", 100.0 * median(besides[1]), "% of the budget"});
    rows.push_back(
        {name + ": besides tracing, at rest", 100.0 * median(besides[0]), "% of the budget"});
    rows.push_back({name + ": largest divider", double(largest), ""});
}

/// Adds the cost of a view that has its passes.
void addUnchanged(Rows& rows, const std::string& name, ViewInputs inputs, const View& view,
                  const Clock& clock)
{
    inputs.maxPasses = 2;
    ViewTracer tracer(clock);
    Display display;
    FrameBudget budget;
    budget.seconds = 0.5;
    for (int i = 0;
         i < 100 && (i < 4 || tracer.progress().passes < 2 || tracer.frame().divider > 1); ++i)
        display.frame(tracer, inputs, view, budget);
    std::vector<double> seconds;
    for (int i = 0; i < 101; ++i)
    {
        display.frame(tracer, inputs, view, budget);
        seconds.push_back(tracer.frame().seconds);
    }
    rows.push_back({name + ": unchanged frame", 1e3 * median(seconds), "ms", Goal::AtMost, 1.0});
}

/// Adds the time to resolve all of full resolution and to copy it; while passes add up, tiles are
/// resolved in the pass.
void addPresenting(Rows& rows, const ViewInputs& inputs, const View& view, const Clock& clock)
{
    RenderSession session(inputs.workers);
    session.setScene(inputs.scene);
    session.setView(view);
    RenderOptions traced;
    traced.integrator = IntegratorKind::Whitted;
    session.setOptions(traced);
    Picture display;
    display.resize(view.width, view.height);
    StopRule rule;
    rule.passes = 2;
    session.render(rule);
    std::vector<double> resolves, copies;
    for (int i = 0; i < 31; ++i)
    {
        resolves.push_back(secondsBy(
            clock,
            [&] { session.resolveDisplay(ToneMap(), display.rgba.data(), display.depth.data()); }));
        copies.push_back(secondsBy(clock, [&] { display.uploadAll(); }));
    }
    rows.push_back(
        {"all of full resolution resolved, not in its pass", 1e3 * median(resolves), "ms"});
    rows.push_back({"a copy of it", 1e3 * median(copies), "ms"});
}

ViewInputs inputsOf(const std::shared_ptr<const Scene>& scene,
                    const std::shared_ptr<Workers>& workers)
{
    ViewInputs inputs;
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    setInputs(inputs, *settings);
    inputs.workers = workers;
    inputs.scene = TracedScene::build(scene, workers);
    inputs.photons = std::make_shared<PhotonPasses>();
    return inputs;
}

/// Returns the Cornell box in fog that scatters 63 % of the light on the way across.
std::shared_ptr<const Scene> inFog(const Scene& box)
{
    auto scene = std::make_shared<Scene>(box);
    Atmosphere air;
    air.medium.sigmaS = Vec3(1.0f / 550.0f);
    scene->atmosphere = std::make_shared<const Atmosphere>(air);
    return scene;
}

/// Returns ten thousand transforms that share one geometry, seen from above at a slant.
ViewInputs fieldInputs(const std::shared_ptr<Workers>& workers)
{
    const ObjectField field(true);
    SceneUpdater updater;
    updater.recordView(nullptr, nullptr, ViewingConditions());
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    updater.update(field.root.get(), *settings, nullptr);
    ViewInputs inputs = updater.version().inputs;
    inputs.workers = workers;
    return inputs;
}

View fieldView(int width, int height)
{
    View view;
    view.width = width;
    view.height = height;
    view.viewFromWorld = glm::lookAt(Vec3d(62, -10, 35), Vec3d(62, 55, 0), Vec3d(0, 0, 1));
    view.clipFromView = glm::perspective(glm::radians(50.0), double(width) / height, 0.1, 1000.0);
    return view;
}

} // namespace

void measureInteractive(const InteractiveOptions& options, Rows& rows)
{
    const auto workers = std::make_shared<Workers>(options.threads);
    const Clock clock = clockOf(options, workers->threads());
    const auto measure = [&](const std::string& name, const auto& makeInputs, const View& view)
    {
        if (name.find(options.only) == std::string::npos) return;
        const ViewInputs inputs = makeInputs();
        for (const double budget : kBudgets)
        {
            char label[64];
            std::snprintf(label, sizeof(label), "%s, %g ms", name.c_str(), budget);
            addTrip(rows, label, travel(inputs, view, 1e-3 * budget, clock), 1e-3 * budget);
        }
        addUnchanged(rows, name, inputs, view, clock);
        if (name == "Cornell box") addPresenting(rows, inputs, view, clock);
    };
    const BenchScene box = cornellBox(options.width, options.height);
    measure(
        "Cornell box", [&] { return inputsOf(box.scene, workers); }, box.view);
    measure(
        "Cornell box in fog", [&] { return inputsOf(inFog(*box.scene), workers); }, box.view);
    const BenchScene sphere = displacedSphere(options.width, options.height);
    measure(
        "a million triangles", [&] { return inputsOf(sphere.scene, workers); }, sphere.view);
    measure(
        "10,000 instances", [&] { return fieldInputs(workers); },
        fieldView(options.width, options.height));
}

} // namespace osgRayTrace::bench
