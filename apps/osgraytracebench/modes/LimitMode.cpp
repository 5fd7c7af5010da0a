// LimitMode.cpp - frames against recorded rays through bare Embree. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/LimitMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "apps/osgraytracebench/yardsticks/BareEmbree.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/session/RenderSession.h"

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 15;

/// Renders one pass of a new image at each call of frame().
class FrameSource
{
public:
    FrameSource(const BenchScene& bench, const RenderOptions& options,
                std::shared_ptr<Workers> workers, std::shared_ptr<const TracedScene> traced)
        : _session(std::move(workers)),
          _options(options),
          _rgba(4 * static_cast<std::size_t>(bench.view.width * bench.view.height)),
          _depth(static_cast<std::size_t>(bench.view.width * bench.view.height))
    {
        _session.setScene(std::move(traced));
        _session.setView(bench.view);
    }

    /// Renders the same rays each time: the seed goes back and forth only to restart the image.
    RenderProgress frame()
    {
        const uint32_t seed = _options.seed;
        _options.seed = seed ^ 1u;
        _session.setOptions(_options);
        StopRule rule;
        rule.passes = 1;
        const DisplayTarget display{ToneMap(), _rgba.data(), _depth.data()};
        return _session.render(rule, {}, &display);
    }

private:
    RenderSession _session;
    RenderOptions _options;
    std::vector<uint8_t> _rgba;
    std::vector<float> _depth;
};

struct Recorded
{
    std::shared_ptr<const TracedScene> traced;
    RecordedRays rays;
};

Recorded record(const BenchScene& bench, const RenderOptions& options)
{
    Recorded recorded;
    auto one = std::make_shared<Workers>(1);
    recorded.traced = TracedScene::build(bench.scene, one);
    FrameSource source(bench, options, one, recorded.traced);
    RayRecorder recorder(recorded.rays);
    source.frame();
    return recorded;
}

double millions(std::size_t rays, double seconds)
{
    return static_cast<double>(rays) / seconds * 1e-6;
}

/// Adds how many times as fast all threads are as one: for bare rays, which tell what the machine
/// has, for ours, and the ratio of the two.
template <class BareRays>
void measureThreads(const std::string& name, const BareRays& bare, FrameSource& all,
                    FrameSource& alone, const Workers& workers, Rows& rows)
{
    if (workers.threads() == 1) return;
    const Workers one(1);
    const std::string threads = std::to_string(workers.threads()) + " threads / 1";
    const PairedTimes bareTimes = timePair(
        kRuns, [&] { bare(one); }, [&] { bare(workers); });
    const PairedTimes ours = timePair(
        kRuns, [&] { alone.frame(); }, [&] { all.frame(); });
    rows.push_back({name + ": bare rays, " + threads, bareTimes.ratio, "times"});
    rows.push_back({name + ": " + threads, ours.ratio, "times", Goal::AtLeast,
                    workers.threads() == 2 ? 1.9 : 0.0});
    rows.push_back({name + ": " + threads + ", of bare rays'", ours.ratio / bareTimes.ratio, ""});
}

void measureFrame(const std::string& name, const BenchScene& bench, double goal, Rows& rows)
{
    RenderOptions options;
    options.integrator = IntegratorKind::Whitted;
    options.lightSamples = 1;
    const Recorded recorded = record(bench, options);
    const std::size_t rays = recorded.rays.camera.size() + recorded.rays.shadow.size();
    const BarePackets bare(recorded.rays);
    auto workers = std::make_shared<Workers>();
    FrameSource source(bench, options, workers, recorded.traced);
    const PairedTimes times = timePair(
        kRuns, [&] { bare.trace(*workers); }, [&] { source.frame(); });
    rows.push_back({name + ": bare packets", millions(rays, times.first), "Mrays/s"});
    rows.push_back({name + ": whole frame", millions(rays, times.second), "Mrays/s"});
    rows.push_back({name + ": whole frame", times.second * 1e3, "ms"});
    rows.push_back({name + ": frame / bare", times.ratio, "of bare rate", Goal::AtLeast, goal});

    FrameSource alone(bench, options, std::make_shared<Workers>(1), recorded.traced);
    const auto bareRays = [&](const Workers& on) { bare.trace(on); };
    measureThreads(name, bareRays, source, alone, *workers, rows);
}

void measurePath(const std::string& name, const BenchScene& bench, double goal, Rows& rows)
{
    RenderOptions options;
    options.integrator = IntegratorKind::Path;
    options.maxBounces = 5;
    const Recorded recorded = record(bench, options);
    const std::size_t rays =
        recorded.rays.camera.size() + recorded.rays.secondary.size() + recorded.rays.shadow.size();
    auto workers = std::make_shared<Workers>();
    FrameSource source(bench, options, workers, recorded.traced);
    const PairedTimes times = timePair(
        kRuns, [&] { traceSingly(recorded.rays, *workers); }, [&] { source.frame(); });
    rows.push_back({name + ": bare single rays", millions(rays, times.first), "Mrays/s"});
    rows.push_back({name + ": path tracing, 5 bounces", millions(rays, times.second), "Mrays/s"});
    rows.push_back({name + ": path / bare", times.ratio, "of bare rate", Goal::AtLeast, goal});

    FrameSource alone(bench, options, std::make_shared<Workers>(1), recorded.traced);
    const auto bareRays = [&](const Workers& on) { traceSingly(recorded.rays, on); };
    measureThreads(name, bareRays, source, alone, *workers, rows);
}

} // namespace

void measureLimit(const std::string& only, Rows& rows)
{
    const auto wanted = [&](const std::string& name)
    { return name.find(only) != std::string::npos; };
    if (wanted("box 1920x1080")) measureFrame("box 1920x1080", cornellBox(1920, 1080), 0.55, rows);
    if (wanted("sphere 1920x1080"))
        measureFrame("sphere 1920x1080", displacedSphere(1920, 1080), 0.75, rows);
    if (wanted("box 640x360")) measurePath("box 640x360", cornellBox(640, 360), 0.60, rows);
    if (wanted("sphere 640x360"))
        measurePath("sphere 640x360", displacedSphere(640, 360), 0.60, rows);
    if (wanted("1 M triangles")) measureBuild(rows);
}

} // namespace osgRayTrace::bench
