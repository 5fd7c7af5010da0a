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
    double moving = 0.0; ///< error of the pixels that show cars that move
};

/// Returns a mark for each pixel that shows a car that moves.
std::vector<uint8_t> movingPixels(const std::shared_ptr<const TracedScene>& scene,
                                  const std::shared_ptr<Workers>& workers, const View& view,
                                  const TrafficScene& town)
{
    RenderSession session(workers);
    session.setScene(scene);
    session.setView(view);
    StopRule rule;
    rule.passes = 1;
    session.render(rule);
    std::vector<uint8_t> marks;
    for (const SurfaceSample& sample : session.surfaceSamples())
        marks.push_back(sample.object > 0 && town.moves(sample.object - 1));
    return marks;
}

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
        const std::vector<uint8_t> marks = movingPixels(scene, workers, view, town);
        const auto addErrors = [&](FrameWalker& walker, Way& way)
        {
            const std::vector<float> picture = walker.tracer.radiance();
            way.error += relMseOf(picture, reference) / kCompared;
            way.moving += relMseOf(picture, reference, marks) / kCompared;
        };
        addErrors(restarting, restarted);
        addErrors(keeping, kept);
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
    rows.push_back({name + "relMSE of cars that move, restarted", restarted.moving, ""});
    rows.push_back({name + "relMSE of cars that move, kept", kept.moving, ""});
    rows.push_back({name + "relMSE of cars that move, restarted / kept, at equal CPU time",
                    restarted.moving / passes / kept.moving, "times"});
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
