// TrafficMode.cpp - frames of traffic with samples kept and not, beside converged pictures. Layer:
// apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/TrafficMode.h"

#include "apps/osgraytracebench/modes/FrameWalker.h"
#include "apps/osgraytracebench/scenes/TrafficScene.h"
#include "osgRayTrace/base/Parallel.h"

#include <memory>

namespace osgRayTrace::bench
{

namespace
{

using namespace engine;

constexpr int kCompared = 3; ///< frames that are compared with converged pictures

/// Holds the sums over the frames of one way to trace them.
struct Way
{
    double error = 0.0, seconds = 0.0;
};

void measureCars(int movers, const TrafficOptions& options, Rows& rows)
{
    const auto workers = std::make_shared<Workers>();
    const TrafficScene town(movers);
    const View view = TrafficScene::view(options.width, options.width * 9 / 16);
    auto scene = TracedScene::build(town.at(0), workers);
    FrameWalker restarting(scene, workers), keeping(scene, workers);
    keeping.inputs.keepsUnchanged = true;
    Way restarted, kept;
    int timed = 0;
    for (int frame = 0; frame < options.frames; ++frame)
    {
        if (frame > 0) scene = TracedScene::build(town.at(frame), workers, scene);
        restarting.inputs.scene = keeping.inputs.scene = scene;
        const double plainSeconds = restarting.show(view), keptSeconds = keeping.show(view);
        if (frame < 2) continue; // the first frames have nothing to keep yet
        restarted.seconds += plainSeconds;
        kept.seconds += keptSeconds;
        ++timed;
        const int left = options.frames - 1 - frame, stride = options.frames / 4;
        if (left % stride != 0 || left / stride >= kCompared) continue;
        const std::vector<float> reference = referenceOf(scene, workers, view, options.references);
        restarted.error += relMseOf(restarting.tracer.radiance(), reference) / kCompared;
        kept.error += relMseOf(keeping.tracer.radiance(), reference) / kCompared;
        if (left > 0 || options.pictures.empty()) continue;
        const std::string stem = options.pictures + "/traffic-" + std::to_string(movers) + "-";
        writePicture(stem + "restarted.png", view, restarting.tracer.radiance());
        writePicture(stem + "kept.png", view, keeping.tracer.radiance());
        writePicture(stem + "reference.png", view, reference);
    }
    const std::string name = std::to_string(movers) + " of 100 cars move: ";
    const double passes = kept.seconds / restarted.seconds;
    rows.push_back({name + "relMSE restarted", restarted.error, ""});
    rows.push_back({name + "relMSE kept", kept.error, ""});
    rows.push_back({name + "relMSE restarted / kept, at equal passes", restarted.error / kept.error,
                    "times", Goal::AtLeast, 4.0});
    rows.push_back({name + "relMSE restarted / kept, at equal CPU time",
                    restarted.error / passes / kept.error, "times", Goal::AtLeast, 4.0});
    rows.push_back(
        {name + "pixels kept", 100.0 * keeping.tracer.progress().stages.reprojectedShare, "%"});
    rows.push_back({name + "finding what is kept, on the wall",
                    1e3 * keeping.tracer.progress().stages.reprojectSeconds, "ms"});
    rows.push_back({name + "CPU time of a frame restarted", 1e3 * restarted.seconds / timed, "ms"});
    rows.push_back({name + "CPU time of a frame kept", 1e3 * kept.seconds / timed, "ms"});
}

} // namespace

void measureTraffic(const TrafficOptions& options, Rows& rows)
{
    for (const int movers : {10, 30})
        measureCars(movers, options, rows);
}

} // namespace osgRayTrace::bench
