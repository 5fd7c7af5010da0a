// RenderInGroup.cpp - a Renderer makes passes for a group, and rank 0 the picture of all. Layer:
// apps.
// SPDX-License-Identifier: MIT
#include "Checkpoint.h"
#include "Picture.h"
#include "Run.h"
#include "apps/common/ErrorLine.h"
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"
#include "apps/common/Program.h"
#include "apps/group/Launcher.h"
#include "apps/group/SharedRender.h"
#include "apps/group/SharedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/ErrorEstimate.h"

#include <chrono>
#include <filesystem>

namespace osgRayTrace::app
{

namespace
{

/// Returns sums as the engine's; they are whole.
engine::PassSums engineSums(PassSums sums)
{
    engine::PassSums result;
    result.width = sums.width;
    result.height = sums.height;
    result.passes = engine::passSetOf(sums.passes).value_or(engine::PassSet());
    result.low = std::move(sums.low);
    result.high = std::move(sums.high);
    result.depth = std::move(sums.depth);
    return result;
}

/// A renderer at work, and what is known of its picture.
struct RankRender
{
    osg::ref_ptr<Renderer> renderer;
    Statistics statistics; ///< after the last pass
    bool displayReferred = false;
    bool veiled = false; ///< PassSums::veiled
};

/// Returns the passes that are done of the sums, as a file of these options.
Checkpoint checkpointOf(const engine::PassSums& sums, const RankRender& render,
                        const Options& options, const Camera& camera)
{
    Checkpoint checkpoint;
    PassSums& kept = checkpoint.sums;
    kept.width = sums.width;
    kept.height = sums.height;
    kept.passes = engine::passText(sums.passes);
    kept.picture = render.renderer->getPictureText();
    kept.low = sums.low;
    kept.high = sums.high;
    kept.depth = sums.depth;
    kept.displayReferred = render.displayReferred;
    kept.veiled = render.veiled;
    checkpoint.exposureEv = options.settings->getExposure();
    checkpoint.clearColor = camera.clearColor;
    checkpoint.toneCurve = options.settings->get("tone-curve");
    return checkpoint;
}

PassWork workOf(RankRender& render, const Options& options)
{
    PassWork work;
    work.width = options.width;
    work.height = options.height;
    work.host = hostName();
    work.processors = processors();
    work.make = [&render](const auto& next, const auto& goesOn)
    {
        render.renderer->setPassSource(next);
        const auto show = [&](const Statistics& statistics)
        {
            render.statistics = statistics;
            return goesOn();
        };
        const bool isRendered = render.renderer->render(0.0, 0.0, show);
        render.statistics = render.renderer->getStatistics();
        return isRendered ? std::string() : render.renderer->getStatistics().message;
    };
    work.picture = [&render] { return render.renderer->getPictureText(); };
    work.sums = [&render]() -> std::optional<engine::PassSums>
    {
        PassSums sums = render.renderer->getPassSums();
        if (sums.passes.empty() && render.statistics.passes > 0) return std::nullopt;
        render.displayReferred = sums.displayReferred;
        render.veiled = sums.veiled;
        return engineSums(std::move(sums));
    };
    work.rays = [&render]
    {
        const Statistics& s = render.statistics;
        return RayTotals{s.cameraRays, s.shadowRays, s.secondaryRays, s.photonRays,
                         s.droppedSamples};
    };
    work.cancel = [&render] { render.renderer->cancel(); };
    return work;
}

/// Takes the rays of all ranks over.
void setRays(const RayTotals& rays, Statistics& statistics)
{
    statistics.cameraRays = rays[0];
    statistics.shadowRays = rays[1];
    statistics.secondaryRays = rays[2];
    statistics.photonRays = rays[3];
    statistics.droppedSamples = rays[4];
}

GroupHooks hooksFor(Progress* progress)
{
    using Clock = std::chrono::steady_clock;
    GroupHooks hooks;
    hooks.now = []
    { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); };
    hooks.isInterrupted = isInterrupted;
    if (!progress) return hooks;
    hooks.progress = [progress](int passes, const RayTotals& rays, double seconds)
    {
        Statistics shown;
        shown.passes = passes;
        shown.renderSeconds = seconds;
        setRays(rays, shown);
        progress->show(shown);
    };
    return hooks;
}

engine::ErrorEstimate errorOf(const engine::PassSums& sums)
{
    engine::Film film;
    engine::setFilm(sums, film);
    return engine::estimateError(film, engine::Workers(1));
}

/// Writes the checkpoint. Returns the exit code: a failure is printed, as the picture is there
/// still, and there may be room later.
int keep(const Options& options, const Checkpoint& checkpoint)
{
    try
    {
        writeCheckpoint(options.checkpoint, checkpoint);
        return kDone;
    }
    catch (const Failure& failure)
    {
        return reportFailure(kProgram, failure);
    }
}

/// Returns what the options want of a group.
GroupPlan planOf(const Options& options, RankRender& render)
{
    GroupPlan plan;
    plan.firstPass = options.firstPass;
    plan.endPass = options.settings->getMaxPasses();
    plan.seconds = options.seconds;
    plan.relativeError = options.relativeError;
    if (options.checkpoint.empty()) return plan;
    plan.interval = options.interval;
    if (!std::filesystem::exists(options.checkpoint)) return plan;
    PassSums before = readCheckpoint(options.checkpoint).sums;
    if (!before.getColorImage())
        throw Failure(kCannotLoad, options.checkpoint + ": the checkpoint is damaged");
    printError(kProgram, options.checkpoint + ": goes on from passes " + before.passes);
    plan.basePicture = before.picture;
    render.displayReferred = before.displayReferred;
    render.veiled = before.veiled;
    plan.base = engineSums(std::move(before));
    return plan;
}

/// Gives the renderer's scene to all ranks. Throws Failure.
void giveScene(Renderer& renderer, const Options& options, Group& group)
{
    SentScene scene{options.width, options.height, renderer.packPicture()};
    if (scene.bytes.empty()) throw Failure(kCannotRender, renderer.getStatistics().message);
    const SendFailure failure = sendScene(group, scene, hooksFor(nullptr).now);
    if (failure.exitCode != 0) throw Failure(failure.exitCode, failure.text);
}

} // namespace

void helpWithoutModel(Options options, Group& group)
{
    std::optional<SentScene> scene = receiveScene(group);
    if (!scene) return;
    options.width = scene->width;
    options.height = scene->height;
    RankRender render{new Renderer, {}, false};
    render.renderer->setSettings(options.settings.get());
    render.renderer->setWholePasses(true);
    if (!render.renderer->unpackPicture(scene->bytes.data(), scene->bytes.size()))
        throw Failure(kCannotRender, render.renderer->getStatistics().message);
    scene.reset();
    helpToRender(group, workOf(render, options), hooksFor(nullptr));
}

void helpInGroup(const Options& options, TimedScene& shown, const Camera& camera, Group& group)
{
    RankRender render{newRenderer(options, shown, camera), {}, false};
    helpToRender(group, workOf(render, options), hooksFor(nullptr));
}

Picture renderInGroup(const Options& options, TimedScene& shown, const Camera& camera,
                      Progress& progress, Group& group)
{
    RankRender render{newRenderer(options, shown, camera), {}, false};
    GroupPlan plan = planOf(options, render);
    if (options.sendsScene && group.size() > 1) giveScene(*render.renderer, options, group);
    const auto judge = [&](const engine::PassSums& sums, bool keeps)
    {
        if (keeps) keep(options, checkpointOf(sums, render, options, camera));
        return options.relativeError > 0.0 ? errorOf(sums).relative : 0.0;
    };
    GroupResult result =
        renderInGroup(group, workOf(render, options), std::move(plan), judge, hooksFor(&progress));
    if (result.exitCode != 0) throw Failure(result.exitCode, result.failure);
    if (!result.sums)
        throw Failure(isInterrupted() ? interruptionCode() : int(kCannotRender),
                      interruptionName() + ": no part of the picture was rendered yet");

    Checkpoint checkpoint = checkpointOf(*result.sums, render, options, camera);
    const engine::ErrorEstimate error = errorOf(*result.sums);
    result.sums.reset();
    const int kept = options.checkpoint.empty() ? kDone : keep(options, checkpoint);

    // The renderer takes all passes over, and makes none.
    Statistics statistics = render.statistics;
    statistics.passes = checkpoint.sums.passCount();
    render.renderer->setPassSource([] { return -1; });
    render.renderer->setPassSums(std::move(checkpoint.sums));
    if (!render.renderer->render())
        throw Failure(kCannotRender, render.renderer->getStatistics().message);
    Picture picture = pictureOf(*render.renderer, options);
    picture.code = kept;
    statistics.ok = true;
    statistics.message.clear();
    statistics.imageShare = 1.0;
    statistics.renderSeconds = result.seconds;
    statistics.relativeError = error.relative;
    statistics.medianError = error.median;
    statistics.worstErrorShare = error.worstShare;
    statistics.denoiser = picture.statistics.denoiser;
    statistics.denoiseMilliseconds = picture.statistics.denoiseMilliseconds;
    statistics.denoiseNote = picture.statistics.denoiseNote;
    setRays(result.rays, statistics);
    picture.statistics = statistics;
    return picture;
}

} // namespace osgRayTrace::app
