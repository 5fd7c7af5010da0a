// ReportMode.cpp - measures the scenes and writes the report. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ReportMode.h"

#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Output.h"
#include "apps/osgraytracebench/report/BoxScenes.h"
#include "apps/osgraytracebench/report/Expectations.h"
#include "apps/osgraytracebench/report/Machine.h"
#include "apps/osgraytracebench/report/Plots.h"
#include "apps/osgraytracebench/report/ReportFiles.h"
#include "apps/osgraytracebench/report/ReportPage.h"
#include "apps/osgraytracebench/report/SamplerStudy.h"
#include "apps/osgraytracebench/report/ScheduleStudy.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/base/TextFile.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kQuickWidth = 32, kFullWidth = 128;
constexpr int kQuickReferencePasses = 1024;
constexpr double kReferenceTimes =
    0.5; ///< time of each of the 8 reference seeds, in longest budgets
constexpr double kLongestDisplaced = 1.0; ///< [s]: enough for a comparison with the origin
constexpr int kPhotonsPerPixel = 4; ///< per pass: 65536 for the square pictures of a full report
constexpr int kCheckFailed = 5;

/// Holds what all parts of a run need.
struct Run
{
    const ReportOptions& options;
    int width;
    std::shared_ptr<engine::Workers> workers;
    Report report;
    std::vector<SceneThumbnails> thumbnails;
};

std::vector<ReportScene> scenesOf(const Run& run)
{
    if (run.options.models.empty()) return reportScenes();
    const osg::ref_ptr<osg::Node> graph = app::readScene(run.options.models);
    // The conversion tells the materials of the graph.
    const std::string name = std::filesystem::path(run.options.models.front()).stem().string();
    const ReportScene asPhysical = modelScene(name, *graph, true);
    const PreparedScene prepared = prepare(asPhysical, atOrigin(), run.width, run.workers);
    const bool physical =
        engine::chooseIntegrator(engine::IntegratorKind::Automatic, prepared.traced->traits()) !=
        engine::IntegratorKind::Whitted;
    bool areaLights = false;
    for (const engine::Light& light : prepared.traced->scene().lights)
        areaLights |=
            light.kind == engine::LightKind::Parallelogram || light.kind == engine::LightKind::Mesh;
    ReportScene scene = modelScene(name, *graph, physical);
    // Without area lights all strategies are one.
    if (!physical && !areaLights) scene.methods = {scene.reference};
    return {scene};
}

std::vector<ReportScene> wantedScenes(const Run& run)
{
    std::vector<ReportScene> scenes;
    for (ReportScene& scene : scenesOf(run))
        if ((scene.quick || !run.options.quick) &&
            scene.name.find(run.options.only) != std::string::npos)
            scenes.push_back(std::move(scene));
    return scenes;
}

/// Returns the photons of a pass: as many for a pixel whatever the width, so that a quick report
/// looks at the estimate of a full one.
int photonsFor(const Run& run, const ReportScene& scene)
{
    return kPhotonsPerPixel * run.width * heightOf(scene, run.width);
}

Reference referenceOf(Run& run, const ReportScene& scene)
{
    if (scene.formula || scene.pictureFormula)
        return formulaReference(scene, run.width, *run.workers);
    ReferencePlan plan;
    if (run.options.quick)
        plan.passes = kQuickReferencePasses;
    else
        plan.seconds = kReferenceTimes * run.options.longest;
    const PreparedScene prepared = prepare(scene, scene.placements.front(), run.width, run.workers);
    ReportScene traced = scene;
    traced.reference.options.photons = scene.referencePhotons * photonsFor(run, scene);
    return renderedReference(traced, prepared, plan, run.options.folder);
}

BudgetPlan planFor(const Run& run, const Method& method, std::size_t placement)
{
    if (run.options.quick) return quickPlan(method, run.options.seeds);
    return timedPlan(placement == 0 ? run.options.longest
                                    : std::min(run.options.longest, kLongestDisplaced));
}

void printLine(const ReportLine& line)
{
    const ReportRow& row = line.rows.back();
    std::printf("%-18s %-10s %-22s %8.3g s  relMSE %9.3g +- %-8.2g bias %+.2g %% (%+.1f)  slope "
                "%.3f +- %.3f\n",
                line.scene.c_str(), line.placement.c_str(), line.method.c_str(), row.seconds,
                row.relMse, row.relMseError, row.biasPercent, row.biasPercent / row.biasError,
                line.slope, line.slopeError);
    std::fflush(stdout);
}

void measureScene(Run& run, const ReportScene& scene)
{
    if (app::isInterrupted()) return;
    const Reference reference = referenceOf(run, scene);
    SceneThumbnails thumbnails{scene.name, scene.title, thumbnail(reference), {}};
    for (std::size_t p = 0; p < scene.placements.size(); ++p)
    {
        const PreparedScene prepared = prepare(scene, scene.placements[p], run.width, run.workers);
        for (Method method : scene.methods)
        {
            // At other placements one of the methods with photons speaks for all, since they share
            // their photons.
            if (p > 0 && hasKernel(method) && method.name != scene.methods.back().name) continue;
            if (app::isInterrupted()) break;
            method.options.photons = photonsFor(run, scene);
            const MeasuredLine measured = measure(scene, scene.placements[p], method, prepared,
                                                  reference, planFor(run, method, p));
            printLine(measured.line);
            run.report.lines.push_back(measured.line);
            if (p > 0) continue; // other placements look alike
            char budget[40];
            std::snprintf(budget, sizeof budget, "%g %s", measured.pictureBudget,
                          run.options.quick ? "passes" : "s");
            thumbnails.lines.push_back({method.name, budget, thumbnail(measured.picture, reference),
                                        errorThumbnail(measured.picture, reference)});
        }
    }
    run.thumbnails.push_back(thumbnails);
}

void measureSamplers(Run& run)
{
    const int receivers = run.options.quick ? 8 : 60, mostSamples = run.options.quick ? 1024 : 4096;
    run.report.samplers = studySamplers(receivers, mostSamples, run.workers);
    for (const SamplerLine& line : run.report.samplers)
    {
        std::printf("%-18s %-22s", line.scene.c_str(), line.strategy.c_str());
        for (const SamplerPoint& point : line.points)
            std::printf(" %9.2e", point.mse);
        std::printf("  slope %.3f +- %.3f\n", line.slope, line.slopeError);
    }
}

void measureSchedules(Run& run)
{
    const int seeds = run.options.quick ? 4 : 8, mostPasses = run.options.quick ? 32 : 128;
    run.report.schedules = studySchedules(seeds, mostPasses, !run.options.quick, run.workers);
    for (const ScheduleLine& line : run.report.schedules)
    {
        const SchedulePoint& last = line.points.back();
        std::printf("%-18s %5d passes: squared bias %9.3g, %.3f of the formula; variance %9.3g, "
                    "%.3f of it\n",
                    line.schedule.c_str(), last.passes, last.biasSquare,
                    last.biasSquare / last.exactBiasSquare, last.variance,
                    last.variance / last.exactVariance);
    }
}

/// Returns whether a study runs: a whole report measures all, and --only the studies whose name
/// begins with it.
bool wanted(const ReportOptions& options, const char* study)
{
    if (!options.models.empty()) return false;
    return options.only.empty() || std::string(study).find(options.only) == 0;
}

constexpr std::size_t kMostExpectationBytes = std::size_t(16) << 20;

std::string expectationsOf(const ReportOptions& options)
{
    if (options.expectations.empty()) return builtInExpectations();
    engine::FileText read = engine::readTextFile(options.expectations, kMostExpectationBytes);
    if (!read.error.empty())
        throw app::Failure(app::kCannotLoad,
                           "cannot read " + options.expectations + ": " + read.error);
    return std::move(read.text);
}

/// Prints all verdicts; returns how many are not met.
int printVerdicts(const std::vector<Verdict>& verdicts)
{
    int failed = 0;
    for (const Verdict& verdict : verdicts)
    {
        std::printf("%s  %s\n", verdict.met ? "ok    " : "FAILED", verdict.text.c_str());
        failed += verdict.met ? 0 : 1;
    }
    std::printf("%zu checks, %d failed\n", verdicts.size(), failed);
    return failed;
}

/// Returns the files of a report: data, table and page.
std::vector<std::string> filesIn(const std::string& folder)
{
    return {folder + "/report.json", folder + "/report.csv", folder + "/report.html"};
}

} // namespace

int runReport(const ReportOptions& options)
{
    const int width = options.width > 0 ? options.width : options.quick ? kQuickWidth : kFullWidth;
    Run run{options, width, std::make_shared<engine::Workers>(), {}, {}};
    run.report.machine = describeMachine(run.workers->threads());
    run.report.timed = !options.quick;
    run.report.width = width;
    const std::vector<ReportScene> scenes = wantedScenes(run);
    const bool samplers = wanted(options, "samplers"), schedules = wanted(options, "schedules");
    if (scenes.empty() && !samplers && !schedules)
        throw app::Failure(app::kUsage, "--only " + options.only + ": no scene of " +
                                            (options.quick ? "a quick" : "the") +
                                            " report has this in its name");
    std::error_code error;
    std::filesystem::create_directories(options.folder, error);
    if (error) throw app::Failure(app::kCannotWrite, "cannot make the folder " + options.folder);
    const std::vector<std::string> files = filesIn(options.folder);
    app::checkOutputs({{"-o", files[0]}, {"-o", files[1]}, {"-o", files[2]}});

    const app::OrderlyEnd end;
    for (const ReportScene& scene : scenes)
        measureScene(run, scene);
    if (samplers && !app::isInterrupted()) measureSamplers(run);
    if (schedules && !app::isInterrupted()) measureSchedules(run);
    const bool whole = options.models.empty() && options.only.empty() && !app::isInterrupted();
    if (app::isInterrupted())
        std::fprintf(stderr, "osgraytracebench: %s: the report is of what was measured so far\n",
                     app::interruptionName().c_str());

    writeJson(run.report, files[0]);
    writeCsv(run.report, files[1]);
    std::vector<Verdict> verdicts;
    if (options.quick && whole) verdicts = checkExpectations(run.report, expectationsOf(options));
    if (!haveGnuplot()) std::printf("gnuplot was not found: the page has tables, but no plots\n");
    app::writeText(files[2], reportPage(run.report, run.thumbnails, verdicts));
    if (verdicts.empty()) return app::kDone;
    return printVerdicts(verdicts) == 0 ? app::kDone : kCheckFailed;
}

} // namespace osgRayTrace::bench
