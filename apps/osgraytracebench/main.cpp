// main.cpp - osgraytracebench: speed and error. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"
#include "apps/common/Output.h"
#include "apps/common/PluginPath.h"
#include "apps/common/Program.h"
#include "apps/osgraytracebench/modes/DenoiseMode.h"
#include "apps/osgraytracebench/modes/FeaturesMode.h"
#include "apps/osgraytracebench/modes/InteractiveMode.h"
#include "apps/osgraytracebench/modes/LimitMode.h"
#include "apps/osgraytracebench/modes/PickMode.h"
#include "apps/osgraytracebench/modes/ReprojectMode.h"
#include "apps/osgraytracebench/modes/UpdateMode.h"
#include "apps/osgraytracebench/modes/UpsampleMode.h"
#include "apps/osgraytracebench/photons/PhotonsMode.h"
#include "apps/osgraytracebench/report/CompareMode.h"
#include "apps/osgraytracebench/report/ReportMode.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::bench;

namespace
{

constexpr const char* kProgram = "osgraytracebench";
constexpr int kCompareUsage = 2;

/// Runs a mode that makes rows. Steps that can fail without measuring come first; a signal leaves
/// the rows measured so far.
int runRows(const std::function<void(Rows&)>& measure, const std::string& json,
            const std::string& pictures = {})
{
    std::vector<app::Output> outputs;
    if (!json.empty()) outputs.push_back({"--json", json});
    if (!pictures.empty()) outputs.push_back({"--pictures", pictures + "/picture.png"});
    app::checkOutputs(outputs);
    const app::OrderlyEnd end;
    Rows rows;
    try
    {
        measure(rows);
    }
    catch (const Interrupted&)
    {
        std::fprintf(stderr, "%s: %s: the rest was not measured\n", kProgram,
                     app::interruptionName().c_str());
    }
    if (rows.list().empty() && app::isInterrupted())
        throw app::Failure(app::interruptionCode(), "there are no rows yet");
    if (rows.list().empty())
        throw app::Failure(app::kUsage, "--only: nothing that is measured has this in its name");
    printRows(rows);
    if (!json.empty()) writeRows(rows, json);
    return app::kDone;
}

/// Holds the modes of the command line.
struct CommandLine
{
    CommandLine()
    {
        for (CLI::App* rows : {&limit, &features, &photons, &update, &pick, &interactive, &denoise,
                               &reproject, &upsample})
            rows->add_option("--json", json, "write the rows to this file as well");

        limit.add_option(
            "--only", limitOnly,
            "parts whose name holds this: box 1920x1080, sphere 640x360, 1 M triangles, ...");
        photons
            .add_option("--width", photonsOptions.width,
                        "width and height of the pictures [pixels]; 0: none are made")
            ->check(CLI::Range(0, 4096))
            ->capture_default_str();
        photons.add_option("--longest", photonsOptions.longest, "longest budget of a picture [s]")
            ->check(CLI::Range(0.125, 86400.0))
            ->capture_default_str();
        photons.add_option("--seeds", photonsOptions.seeds, "pictures of each method")
            ->check(CLI::Range(1, 64))
            ->capture_default_str();
        photons
            .add_option("--reference-seconds", photonsOptions.referenceSeconds,
                        "time for each reference that is rendered [s]")
            ->check(CLI::Range(1.0, 86400.0))
            ->capture_default_str();
        photons.add_option("--reference-a", photonsOptions.referenceA,
                           "linear picture of the diffuse box; rendered if not given");
        photons.add_option("--reference-b", photonsOptions.referenceB, "of the box with a mirror");
        photons.add_option("--reference-c", photonsOptions.referenceC,
                           "of the box with a glass sphere");
        photons
            .add_option("--runs", photonsOptions.runs,
                        "timings of each rate, of which the median counts")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        photons.add_option("--photons", photonsOptions.photons, "photons of look-ups")
            ->check(CLI::Range(1000, 10000000))
            ->capture_default_str();
        photons.add_option("--only", photonsOptions.only,
                           "parts whose name holds this: lookup, tracing, error");

        upsample.add_option("--pictures", pictures, "write the pictures to this folder as well");
        upsample.add_option("MODEL", models, "measure these files, too");
        interactive.add_option("--width", interactiveOptions.width, "width of the view [pixels]")
            ->check(CLI::Range(16, 8192))
            ->capture_default_str();
        interactive
            .add_option("--height", interactiveOptions.height, "height of the view [pixels]")
            ->check(CLI::Range(16, 8192))
            ->capture_default_str();
        interactive
            .add_option("--threads", interactiveOptions.threads,
                        "threads to trace with; 0: all of the machine")
            ->check(CLI::Range(0, 1024))
            ->capture_default_str();
        interactive.add_flag("--cpu-clock", interactiveOptions.cpuClock,
                             "time by what the process takes of its cores, over its threads: as "
                             "on a machine of its own");
        interactive.add_option("--only", interactiveOptions.only,
                               "scenes whose name holds this: Cornell box, triangles, instances");
        reproject
            .add_option("--width", reprojectOptions.width,
                        "width of the pictures whose error is measured [pixels]")
            ->check(CLI::Range(16, 4096))
            ->capture_default_str();
        reproject
            .add_option("--references", reprojectOptions.references,
                        "passes of the pictures that they are compared with")
            ->check(CLI::Range(1, 1 << 20))
            ->capture_default_str();
        reproject.add_option("--pictures", reprojectOptions.pictures,
                             "write the last frames to this folder");
        reproject.add_flag("!--no-costs", reprojectOptions.costs,
                           "leave the frames of 1920 x 1080 out");

        report.add_option("-o,--output", options.folder, "folder of report.html, .csv and .json")
            ->capture_default_str();
        report.add_flag(
            "--quick", options.quick,
            "count passes, not seconds, and check what came out: minutes; ends with 5 if a "
            "check fails");
        report.add_option("--longest", options.longest, "longest budget of a picture [s]")
            ->check(CLI::Range(0.125, 86400.0))
            ->capture_default_str();
        report
            .add_option("--width", options.width,
                        "width of the pictures [pixels]; 0: 128, quick 32")
            ->check(CLI::Range(0, 4096));
        report.add_option(
            "--only", options.only,
            "scenes whose name holds this; \"samplers\", \"schedules\" for these alone");
        report.add_option("--expectations", options.expectations,
                          "check a quick report against this file, not the built-in one");
        report.add_option("MODEL", options.models, "measure these files, together one scene");

        compare.add_option("BEFORE", before, "report.json")->required();
        compare.add_option("AFTER", after, "report.json")->required();
        compare
            .add_option("--false-alarms", falseAlarmRate,
                        "probability that chance alone makes a change")
            ->check(CLI::Range(1e-9, 0.5))
            ->capture_default_str();
        compare.footer("Ends with 0 if no row changed by more than its noise, 1 if one did, 2 if "
                       "the files cannot "
                       "be compared.");
        application.require_subcommand(1);
    }

    int run()
    {
        if (limit) return runRows([&](Rows& rows) { measureLimit(limitOnly, rows); }, json);
        if (features) return runRows(measureFeatures, json);
        if (pick) return runRows(measurePicks, json);
        if (interactive)
            return runRows([&](Rows& rows) { measureInteractive(interactiveOptions, rows); }, json);
        if (denoise) return runRows(measureDenoise, json);
        if (update) return runRows(measureUpdate, json);
        if (photons)
            return runRows([&](Rows& rows) { measurePhotons(photonsOptions, rows); }, json);
        if (reproject)
            return runRows([&](Rows& rows) { measureReprojection(reprojectOptions, rows); }, json,
                           reprojectOptions.pictures);
        if (compare) return runCompare(before, after, falseAlarmRate);
        app::addPluginPath();
        if (upsample)
            return runRows([&](Rows& rows) { measureUpsampling(models, pictures, rows); }, json,
                           pictures);
        return runReport(options);
    }

    CLI::App application{"Speed and error of osgRayTrace."};
    CLI::App& limit = *application.add_subcommand(
        "limit", "a whole frame, a path traced one and a build against Embree alone");
    CLI::App& features = *application.add_subcommand(
        "features", "what features cost a scene that does not use them");
    CLI::App& photons = *application.add_subcommand(
        "photons", "photon maps against a plain grid and Embree alone; error against time");
    CLI::App& update = *application.add_subcommand(
        "update", "what edits of a large live scene cost, against Embree alone");
    CLI::App& pick =
        *application.add_subcommand("pick", "what a pick costs, against osgUtil's own and one ray");
    CLI::App& upsample = *application.add_subcommand(
        "upsample", "what images of fewer pixels lose, and what it costs to show them");
    CLI::App& interactive = *application.add_subcommand(
        "interactive", "whether the frames of a moving camera keep to their budgets");
    CLI::App& denoise = *application.add_subcommand(
        "denoise",
        "how much error the denoiser takes from one and four passes, and how long it takes");
    CLI::App& reproject = *application.add_subcommand(
        "reproject", "what a moving view gains from its earlier frames, and what they cost");
    CLI::App& report =
        *application.add_subcommand("report", "error against time, of all methods on many scenes");
    CLI::App& compare = *application.add_subcommand(
        "compare", "which rows of two reports differ by more than their noise");
    std::string json, limitOnly, before, after, pictures;
    std::vector<std::string> models;
    double falseAlarmRate = 0.01;
    ReportOptions options;
    PhotonsOptions photonsOptions;
    InteractiveOptions interactiveOptions;
    ReprojectOptions reprojectOptions;
};

} // namespace

int main(int argc, char** argv)
{
    return app::runProgram(kProgram,
                           [=]() -> int
                           {
                               CommandLine commandLine;
                               try
                               {
                                   commandLine.application.parse(argc, argv);
                               }
                               catch (const CLI::ParseError& error)
                               {
                                   if (commandLine.application.exit(error) == 0) return app::kDone;
                                   // compare's exit code 1 says that something changed.
                                   const bool comparing =
                                       argc > 1 && std::string(argv[1]) == "compare";
                                   return comparing ? kCompareUsage : app::kUsage;
                               }
                               return commandLine.run();
                           });
}
