// BackgroundTracerTest.cpp - a worker that is held whenever it looks at its clock: who waits for
// the worker, what it hands over, and when it sleeps. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/BackgroundThreads.h"
#include "osgRayTrace/session/view/BackgroundTracer.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 64, kHeight = 48; // 12 tiles
constexpr long kAll = std::numeric_limits<long>::max();

/// A clock that moves on by 1 with each look, and holds its caller after the number of looks that
/// pass() has allowed.
class Gate
{
public:
    double look()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        _held = _looks == _passing;
        _changed.notify_all();
        _changed.wait(lock, [this] { return _looks < _passing; });
        _held = false;
        return double(++_looks);
    }

    void pass(long looks)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _passing = looks == kAll ? kAll : _passing + looks;
        _changed.notify_all();
    }

    /// Waits until the worker is held by the gate.
    void awaitHeld()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        _changed.wait(lock, [this] { return _held && _looks == _passing; });
    }

    long looks() const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        return _looks;
    }

private:
    mutable std::mutex _mutex; // the worker, and the test
    std::condition_variable _changed;
    long _looks = 0, _passing = 0;
    bool _held = false;
};

/// Waits for what another thread will bring about, and gives up after a minute.
template <class Condition> bool eventually(const Condition& condition)
{
    for (int i = 0; i < 60000; ++i)
    {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

View viewAt(double x)
{
    return perspectiveView({278 + x, 278, 20}, {278, 250, 559}, {0, 1, 0}, 50.0, kWidth, kHeight);
}

struct Pixels
{
    std::vector<uint8_t> rgba;
    std::vector<float> depth;

    bool operator==(const TracedImage& image) const
    {
        const TracedPixels* pixels = image.pixels.get();
        return pixels && pixels->width == kWidth && pixels->height == kHeight &&
               std::memcmp(pixels->rgba.data(), rgba.data(), rgba.size()) == 0 &&
               std::memcmp(pixels->depth.data(), depth.data(), depth.size() * sizeof(float)) == 0;
    }
};

/// A scene, the worker of one view, and the images that the worker should make.
struct Desk
{
    Desk()
        : gate(std::make_shared<Gate>()), // the worker has the gate, too, and outlives the desk
          tracer(std::make_unique<BackgroundTracer>([gate = gate] { return gate->look(); }))
    {
        inputs.options.integrator = IntegratorKind::Path;
        inputs.options.maxBounces = 1;
        inputs.maxPasses = 1;
        inputs.scene = cornellBox().build();
        inputs.workers = std::make_shared<Workers>(1);
        inputs.photons = std::make_shared<PhotonPasses>();
    }
    ~Desk() { gate->pass(kAll); }

    void ask(double x)
    {
        const View view = viewAt(x);
        tracer->ask({inputs, view, {view}, budget, true}, ++frame);
    }

    /// Returns the image that a session makes of a view if nobody interrupts the session.
    const Pixels& reference(double x, int passes = 1, float exposure = 0.0f)
    {
        Pixels& pixels = references[{x, passes, exposure}];
        if (!pixels.rgba.empty()) return pixels;
        pixels.rgba.resize(4 * kWidth * kHeight);
        pixels.depth.resize(kWidth * kHeight);
        RenderSession session(std::make_shared<Workers>(1));
        session.setScene(inputs.scene);
        session.setView(viewAt(x));
        session.setOptions(inputs.options);
        StopRule rule;
        rule.passes = passes;
        session.render(rule);
        session.resolveDisplay({exposure, false}, pixels.rgba.data(), pixels.depth.data());
        return pixels;
    }

    /// Lets looks pass one by one until the condition holds; returns their number.
    template <class Condition> long passUntil(const Condition& condition)
    {
        long passed = 0;
        for (gate->awaitHeld(); !condition(); ++passed)
        {
            gate->pass(1);
            gate->awaitHeld();
        }
        return passed;
    }

    bool rests() const
    {
        return eventually([&] { return !tracer->isWorking(); });
    }

    std::shared_ptr<Gate> gate;
    ViewInputs inputs;
    FrameBudget budget;
    uint64_t frame = 0;
    TracedImage shown;
    std::map<std::tuple<double, int, float>, Pixels> references;
    std::unique_ptr<BackgroundTracer> tracer;
};

} // namespace

TEST_CASE("background: who asks never waits, and what was begun first is shown first", "[session]")
{
    Desk desk;
    desk.ask(0.0);
    desk.gate->awaitHeld(); // the worker traces view 0
    for (int i = 1; i <= 100; ++i)
    {
        desk.ask(i);
        CHECK_FALSE(desk.tracer->takeNewest(desk.shown));
        CHECK(desk.tracer->report(desk.frame).progress.passes == 0);
    }
    CHECK(desk.tracer->isWorking());

    desk.passUntil([&] { return desk.tracer->takeNewest(desk.shown); });
    CHECK(desk.reference(0.0) == desk.shown);
    desk.passUntil([&] { return desk.tracer->takeNewest(desk.shown); });
    CHECK(desk.reference(100.0) == desk.shown); // views 1 to 99 are no longer wanted
    desk.gate->pass(kAll);
    REQUIRE(desk.rests());
    CHECK_FALSE(desk.tracer->takeNewest(desk.shown));
}

TEST_CASE("background: a view that moves has images all the time, each of one view and complete",
          "[session]")
{
    Desk desk;
    desk.gate->pass(kAll);
    int images = 0;
    REQUIRE(eventually(
        [&]
        {
            desk.ask(desk.frame % 5); // the view moves in each frame
            if (!desk.tracer->takeNewest(desk.shown)) return false;
            bool asked = false;
            for (int x = 0; x < 5; ++x)
                asked |= desk.reference(x) == desk.shown;
            CHECK(asked);
            return ++images == 40;
        }));
    CHECK(desk.tracer->report(desk.frame).age >= 0);
}

TEST_CASE("background: once an image is there, another view cuts the pass at work short",
          "[session]")
{
    Desk desk;
    desk.inputs.maxPasses = 100000;
    desk.budget = {2000.0, false}; // in looks: each tile is one look
    const auto stepEnds = [&] { return desk.tracer->report(desk.frame).fresh; };
    desk.ask(0.0);
    desk.passUntil(stepEnds);
    const int passes = desk.tracer->report(desk.frame).progress.passes;
    desk.gate->pass(100);
    desk.gate->awaitHeld(); // the worker is within the second step
    desk.ask(1.0);
    CHECK(desk.passUntil(stepEnds) < 20);
    CHECK(desk.tracer->report(desk.frame).progress.passes < passes + 20);
    CHECK(desk.tracer->report(desk.frame).age > 0);

    // The first image of a view is completed even if another view is asked for.
    desk.gate->pass(100);
    desk.gate->awaitHeld();
    desk.ask(2.0);
    CHECK(desk.passUntil(stepEnds) > 500);
}

TEST_CASE(
    "background: at rest passes add up to those of a frame-locked view, bit by bit, then it sleeps",
    "[session]")
{
    Desk desk;
    desk.inputs.maxPasses = 5;
    const bool budgeted = GENERATE(false, true);
    if (budgeted) desk.budget.seconds = 5.0; // less than half a pass
    desk.gate->pass(kAll);
    desk.ask(0.0);
    REQUIRE(desk.rests());
    REQUIRE(desk.tracer->takeNewest(desk.shown));
    CHECK(desk.reference(0.0, 5) == desk.shown);
    const RenderProgress done = desk.tracer->report(desk.frame).progress;
    CHECK(done.passes == 5);
    CHECK(desk.tracer->report(desk.frame).age == 0);

    // The view that is asked for again differs by OSG's rounding at most: the worker does not even
    // look at its clock.
    const long looks = desk.gate->looks();
    View same = viewAt(0.0);
    same.clipFromView[2][2] *= 1.0 + 1e-15;
    desk.tracer->ask({desk.inputs, same, {same}, desk.budget, true}, ++desk.frame);
    desk.ask(0.0);
    CHECK_FALSE(desk.tracer->isWorking());
    CHECK(desk.gate->looks() == looks);

    // Another exposure gives another picture of the same samples.
    desk.inputs.exposureEv = 1.0f;
    desk.ask(0.0);
    REQUIRE(desk.rests());
    REQUIRE(desk.tracer->takeNewest(desk.shown));
    CHECK(desk.reference(0.0, 5, 1.0f) == desk.shown);
    CHECK(desk.tracer->report(desk.frame).progress.rays.total() == done.rays.total());
}

TEST_CASE("background: a view that nobody asks for any more rests", "[session]")
{
    Desk desk;
    desk.inputs.maxPasses = 100000;
    desk.gate->pass(kAll);
    desk.ask(0.0);
    REQUIRE(desk.rests());
    CHECK(desk.tracer->report(desk.frame).progress.passes == BackgroundTracer::kMostUnasked);
    desk.ask(0.0);
    REQUIRE(desk.rests());
    CHECK(desk.tracer->report(desk.frame).progress.passes == 2 * BackgroundTracer::kMostUnasked);
}

TEST_CASE("background: the exposure of a finished image comes to rest", "[session]")
{
    Desk desk;
    desk.inputs.options.maxBounces = 2;
    desk.inputs.autoExposure = true;
    desk.gate->pass(kAll);
    desk.ask(0.0);
    REQUIRE(desk.rests());
    const float before = desk.tracer->report(desk.frame).progress.stages.autoEv;
    SceneBuilder brighter = cornellBox();
    for (Light& light : brighter.scene->lights)
        light.radiance *= 16.0f;
    desk.inputs.scene = brighter.build();
    for (int i = 0; i < 60; ++i)
    {
        desk.ask(0.0);
        REQUIRE(desk.rests());
    }
    const float after = desk.tracer->report(desk.frame).progress.stages.autoEv;
    CHECK(std::abs(before - after - 4.0f) < EasedExposure::kTolerance);
}

TEST_CASE("background: destroyed while its worker traces it does not wait, and nothing stays",
          "[session]")
{
    Desk desk;
    const std::weak_ptr<const TracedScene> scene = desk.inputs.scene;
    desk.ask(0.0);
    desk.gate->awaitHeld();
    desk.tracer.reset();
    desk.inputs = ViewInputs();
    CHECK_FALSE(scene.expired()); // the worker still traces the scene
    desk.gate->pass(kAll);
    CHECK(eventually([&] { return scene.expired(); }));
}

TEST_CASE(
    "background: stopped, the image goes on in the hands of others, and in the background again",
    "[session]")
{
    Desk desk;
    desk.inputs.maxPasses = 100000;
    desk.ask(0.0);
    desk.passUntil([&] { return desk.tracer->report(desk.frame).progress.passes == 3; });
    desk.tracer->stop();
    desk.gate->pass(kAll);
    int passes = 0;
    {
        const auto tracer = desk.tracer->lease();
        passes = tracer->progress().passes;
        CHECK(passes >= 3);
        tracer->forgetDisplay();
        tracer->trace(desk.inputs, viewAt(0.0));
        CHECK(tracer->progress().passes == passes + 1);
    }
    CHECK_FALSE(desk.tracer->takeNewest(desk.shown)); // images of before are gone
    CHECK(desk.rests());                              // the thread ends
    desk.inputs.maxPasses = passes + 4;
    desk.ask(0.0);
    REQUIRE(desk.rests());
    REQUIRE(desk.tracer->takeNewest(desk.shown));
    CHECK(desk.reference(0.0, passes + 4) == desk.shown);
}

TEST_CASE("background: who borrows the tracer comes before the next step", "[session]")
{
    Desk desk;
    desk.inputs.maxPasses = 100000;
    desk.gate->pass(kAll);
    for (int i = 0; i < 50; ++i)
    {
        desk.ask(0.0);
        CHECK(desk.tracer->lease()->progress().passes >= 0);
    }
}

TEST_CASE("background: what cannot be traced is reported, not tried on and on, and tried again "
          "when asked for",
          "[session]")
{
    Desk desk;
    desk.gate->pass(kAll);
    View view = viewAt(0.0);
    view.width = view.height = 20000; // more pixels than a film holds
    for (int i = 0; i < 3; ++i)
    {
        desk.tracer->ask({desk.inputs, view, {view}, {}, true}, ++desk.frame);
        REQUIRE(desk.rests());
        const TraceReport report = desk.tracer->report(desk.frame);
        CHECK_FALSE(report.progress.status.ok());
        CHECK(report.progress.passes == 0);
        CHECK(report.fresh);
        CHECK((report.scene.lock() == desk.inputs.scene));
        CHECK_FALSE(desk.tracer->takeNewest(desk.shown));
        CHECK_FALSE(desk.tracer->report(desk.frame).fresh);
    }
    desk.ask(0.0);
    REQUIRE(desk.rests());
    CHECK(desk.tracer->report(desk.frame).progress.status.ok());
    REQUIRE(desk.tracer->takeNewest(desk.shown));
    CHECK(desk.reference(0.0) == desk.shown);
}

TEST_CASE("background: several views share a pool of threads, photons and a scene", "[session]")
{
    Desk desk;
    desk.inputs.options.integrator = IntegratorKind::Ppm;
    desk.inputs.options.photons = 2000;
    desk.inputs.maxPasses = 3;
    desk.inputs.options.photonGuiding = false;
    std::vector<std::unique_ptr<BackgroundTracer>> tracers;
    for (int i = 0; i < 4; ++i)
    {
        tracers.push_back(std::make_unique<BackgroundTracer>());
        tracers[i]->ask({desk.inputs, viewAt(i), {viewAt(i)}, {}, true}, 1);
    }
    for (int i = 0; i < 4; ++i)
    {
        REQUIRE(eventually([&] { return !tracers[i]->isWorking(); }));
        REQUIRE(tracers[i]->takeNewest(desk.shown));
        CHECK(desk.reference(i, 3) == desk.shown);
    }
}

TEST_CASE("background: each thread of a worker is prepared once, before it traces", "[session]")
{
    Desk desk;
    desk.gate->pass(kAll);
    std::vector<std::thread::id> prepared;
    long looks = -1; // before the first one was prepared
    desk.tracer =
        std::make_unique<BackgroundTracer>([gate = desk.gate] { return gate->look(); },
                                           [&]
                                           {
                                               if (looks < 0) looks = desk.gate->looks();
                                               prepared.push_back(std::this_thread::get_id());
                                           });
    desk.ask(0.0);
    REQUIRE(desk.rests());
    REQUIRE(prepared.size() == 1);
    CHECK(prepared.front() != std::this_thread::get_id());
    CHECK(looks == 0);
    CHECK(desk.gate->looks() > 0);

    desk.ask(1.0);
    REQUIRE(desk.rests());
    CHECK(prepared.size() == 1);
    desk.tracer->stop();
    REQUIRE(desk.rests());
    desk.ask(2.0);
    REQUIRE(desk.rests());
    CHECK(prepared.size() == 2);
}

// This test runs in a process of its own, because it checks that the process ends.
TEST_CASE("background: who asks on while the process ends does not keep the worker from ending",
          "[.][ask-while-exiting]")
{
    static Desk& desk = *new Desk;
    desk.ask(0.0);
    desk.gate->awaitHeld(); // the worker is tracing
    const auto askOn = []
    {
        desk.ask(1.0); // the worker has been told to stop: threads stop in the order of their start
        desk.gate->pass(kAll);
    };
    REQUIRE(startBackgroundThread([] {}, askOn));
    std::exit(0);
}
