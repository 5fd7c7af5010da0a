// main.cpp - osgraytracebench: speed and error. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"
#include "apps/common/Output.h"
#include "apps/common/PluginPath.h"
#include "apps/common/Program.h"
#include "apps/osgraytracebench/modes/DaylightMode.h"
#include "apps/osgraytracebench/modes/DenoiseMode.h"
#include "apps/osgraytracebench/modes/FeaturesMode.h"
#include "apps/osgraytracebench/modes/InteractiveMode.h"
#include "apps/osgraytracebench/modes/LampsMode.h"
#include "apps/osgraytracebench/modes/LimitMode.h"
#include "apps/osgraytracebench/modes/MovingMode.h"
#include "apps/osgraytracebench/modes/PickMode.h"
#include "apps/osgraytracebench/modes/ReprojectMode.h"
#include "apps/osgraytracebench/modes/TrafficMode.h"
#include "apps/osgraytracebench/modes/TransportMode.h"
#include "apps/osgraytracebench/modes/UpdateMode.h"
#include "apps/osgraytracebench/modes/UpsampleMode.h"
#include "apps/osgraytracebench/photons/PhotonsMode.h"
#include "apps/osgraytracebench/report/CompareMode.h"
#include "apps/osgraytracebench/report/ReportMode.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
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

/// Runs a mode once its options are read, which the function owns.
using Run = std::function<int()>;

/// Adds an option of a number from least to most.
template <class Number, class Bound>
void addNumber(CLI::App& mode, const std::string& name, Number& value, Bound least, Bound most,
               const std::string& description)
{
    mode.add_option(name, value, description)
        ->check(CLI::Range(least, most))
        ->capture_default_str();
}

/// Adds the options of the views that the interactive modes show.
template <class Options> void addViewSize(CLI::App& mode, Options& options)
{
    addNumber(mode, "--width", options.width, 16, 8192, "width of the view [pixels]");
    addNumber(mode, "--height", options.height, 16, 8192, "height of the view [pixels]");
}

/// Adds the option by which times are those of the processor.
template <class Options> void addCpuClock(CLI::App& mode, Options& options)
{
    mode.add_flag("--cpu-clock", options.cpuClock,
                  "time by what the process takes of its cores, over its threads: as on a machine "
                  "of its own");
}

std::shared_ptr<std::string> addJson(CLI::App& mode)
{
    auto json = std::make_shared<std::string>();
    mode.add_option("--json", *json, "write the rows to this file as well");
    return json;
}

/// Returns the run of a mode that has no option but --json.
template <void (*measure)(Rows&)> Run addRows(CLI::App& mode)
{
    return [json = addJson(mode)] { return runRows(measure, *json); };
}

/// Returns the run of a mode that measures named parts, and adds the option that chooses among
/// them. parts: names of some of the parts, as examples in the option's help.
template <void (*measure)(const std::string&, Rows&)>
Run addParts(CLI::App& mode, const std::string& parts)
{
    const auto json = addJson(mode);
    const auto only = std::make_shared<std::string>();
    mode.add_option("--only", *only, "parts whose name holds this: " + parts + ", ...");
    return [=] { return runRows([&](Rows& rows) { measure(*only, rows); }, *json); };
}

Run addLimit(CLI::App& mode)
{
    return addParts<measureLimit>(mode, "box 1920x1080, sphere 640x360, 1 M triangles");
}

Run addLamps(CLI::App& mode)
{
    return addParts<measureLamps>(mode, "hall, rooms, points, triangles, million");
}

Run addDaylight(CLI::App& mode)
{
    return addParts<measureDaylight>(mode, "window, pane, sky, panel, Cornell");
}

Run addFeatures(CLI::App& mode)
{
    return addParts<measureFeatures>(mode, "textures, alpha, proxy, captures");
}

Run addPhotons(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto options = std::make_shared<PhotonsOptions>();
    addNumber(mode, "--width", options->width, 0, 4096,
              "width and height of the pictures [pixels]; 0: none are made");
    addNumber(mode, "--longest", options->longest, 0.125, 86400.0,
              "longest budget of a picture [s]");
    addNumber(mode, "--seeds", options->seeds, 1, 64, "pictures of each method");
    addNumber(mode, "--reference-seconds", options->referenceSeconds, 1.0, 86400.0,
              "time for each reference that is rendered [s]");
    mode.add_option("--reference-a", options->referenceA,
                    "linear picture of the diffuse box; rendered if not given");
    mode.add_option("--reference-b", options->referenceB, "of the box with a mirror");
    mode.add_option("--reference-c", options->referenceC, "of the box with a glass sphere");
    addNumber(mode, "--runs", options->runs, 1, 1000,
              "timings of each rate, of which the median counts");
    addNumber(mode, "--photons", options->photons, 1000, 10000000, "photons of look-ups");
    mode.add_option("--only", options->only,
                    "parts whose name holds this: lookup, beams, tracing, error");
    return [=] { return runRows([&](Rows& rows) { measurePhotons(*options, rows); }, *json); };
}

Run addTransport(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto options = std::make_shared<TransportOptions>();
    addNumber(mode, "--width", options->width, 8, 4096, "width of the pictures [pixels]");
    addNumber(mode, "--seconds", options->seconds, 0.125, 86400.0,
              "budget of a picture [s of one thread]");
    addNumber(mode, "--seeds", options->seeds, 2, 64, "pictures of each method");
    addNumber(mode, "--first-seed", options->firstSeed, 1, 1000000, "seed of the first picture");
    addNumber(mode, "--reference-seconds", options->referenceSeconds, 1.0, 86400.0,
              "budget of each reference that is rendered [s of one thread]");
    mode.add_option("--only", options->only,
                    "scenes whose name holds this: two-spheres, ajar, window, city, ...");
    return [=] { return runRows([&](Rows& rows) { measureTransport(*options, rows); }, *json); };
}

Run addUpsample(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto pictures = std::make_shared<std::string>();
    const auto models = std::make_shared<std::vector<std::string>>();
    mode.add_option("--pictures", *pictures, "write the pictures to this folder as well");
    mode.add_option("MODEL", *models, "measure these files, too");
    return [=]
    {
        app::addPluginPath();
        return runRows([&](Rows& rows) { measureUpsampling(*models, *pictures, rows); }, *json,
                       *pictures);
    };
}

Run addInteractive(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto options = std::make_shared<InteractiveOptions>();
    addViewSize(mode, *options);
    addNumber(mode, "--threads", options->threads, 0, 1024,
              "threads to trace with; 0: all of the machine");
    addCpuClock(mode, *options);
    mode.add_option("--only", options->only,
                    "scenes whose name holds this: Cornell box, triangles, instances");
    return [=] { return runRows([&](Rows& rows) { measureInteractive(*options, rows); }, *json); };
}

Run addMoving(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto options = std::make_shared<MovingOptions>();
    addViewSize(mode, *options);
    addNumber(mode, "--threads", options->threads, 1, 1024, "threads to trace with");
    addNumber(mode, "--budget", options->budget, 0.1, 10000.0, "budget of a frame [ms]");
    addCpuClock(mode, *options);
    addNumber(mode, "--references", options->references, 1, 1 << 20,
              "passes of the pictures that frames are compared with");
    mode.add_flag_callback(
        "--path", [options] { options->integrator = engine::IntegratorKind::Path; },
        "trace paths, where whitted would do");
    mode.add_option("--pictures", options->pictures, "write the pictures to this folder as well");
    mode.add_option("--only", options->only,
                    "scenes whose name holds this: terrain, traffic or that of a MODEL");
    mode.add_option("MODEL", options->models, "measure these files, too");
    return [=]
    {
        app::addPluginPath();
        return runRows([&](Rows& rows) { measureMoving(*options, rows); }, *json,
                       options->pictures);
    };
}

Run addReproject(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto options = std::make_shared<ReprojectOptions>();
    addNumber(mode, "--width", options->width, 16, 4096,
              "width of the pictures whose error is measured [pixels]");
    addNumber(mode, "--references", options->references, 1, 1 << 20,
              "passes of the pictures that they are compared with");
    mode.add_option("--pictures", options->pictures, "write the last frames to this folder");
    mode.add_flag("!--no-costs", options->costs, "leave the frames of 1920 x 1080 out");
    return [=]
    {
        return runRows([&](Rows& rows) { measureReprojection(*options, rows); }, *json,
                       options->pictures);
    };
}

Run addTraffic(CLI::App& mode)
{
    const auto json = addJson(mode);
    const auto options = std::make_shared<TrafficOptions>();
    addNumber(mode, "--width", options->width, 16, 4096, "width of the pictures [pixels]");
    addNumber(mode, "--references", options->references, 1, 1 << 20,
              "passes of the pictures that they are compared with");
    addNumber(mode, "--frames", options->frames, 8, 1 << 16, "frames of each town");
    mode.add_option("--pictures", options->pictures, "write the last frames to this folder");
    return [=] {
        return runRows([&](Rows& rows) { measureTraffic(*options, rows); }, *json,
                       options->pictures);
    };
}

Run addReport(CLI::App& mode)
{
    const auto options = std::make_shared<ReportOptions>();
    mode.add_option("-o,--output", options->folder, "folder of report.html, .csv and .json")
        ->capture_default_str();
    mode.add_flag("--quick", options->quick,
                  "count passes, not seconds, and check what came out: minutes; ends with 5 if a "
                  "check fails");
    addNumber(mode, "--longest", options->longest, 0.125, 86400.0,
              "longest budget of a picture [s]");
    mode.add_option("--width", options->width, "width of the pictures [pixels]; 0: 128, quick 32")
        ->check(CLI::Range(0, 4096));
    mode.add_option("--seeds", options->seeds,
                    "pictures of each method of a quick report, each with another seed; 0: 8 with "
                    "photons, else 16")
        ->check(CLI::Range(0, 100000));
    mode.add_option("--only", options->only,
                    "scenes whose name holds this; \"samplers\", \"schedules\" for these alone");
    mode.add_option("--expectations", options->expectations,
                    "check a quick report against this file, not the built-in one");
    mode.add_option("MODEL", options->models, "measure these files, together one scene");
    return [=]
    {
        app::addPluginPath();
        return runReport(*options);
    };
}

Run addCompare(CLI::App& mode)
{
    struct Options
    {
        std::string before, after;
        double falseAlarmRate = 0.01;
    };
    const auto options = std::make_shared<Options>();
    mode.add_option("BEFORE", options->before, "report.json")->required();
    mode.add_option("AFTER", options->after, "report.json")->required();
    addNumber(mode, "--false-alarms", options->falseAlarmRate, 1e-9, 0.5,
              "probability that chance alone makes a change");
    mode.footer("Ends with 0 if no row changed by more than its noise, 1 if one did, 2 if the "
                "files cannot be compared.");
    return [=] { return runCompare(options->before, options->after, options->falseAlarmRate); };
}

/// The modes of the command line.
class CommandLine
{
public:
    CommandLine()
    {
        add("limit", "a whole frame, a path traced one and a build against Embree alone", addLimit);
        add("lamps", "error and cost of path tracing under many lamps", addLamps);
        add("daylight", "error and cost of rooms with a window, skies and large panels",
            addDaylight);
        add("features", "what features cost a scene that does not use them", addFeatures);
        add("photons", "photon maps against a plain grid and Embree alone; error against time",
            addPhotons);
        add("update", "what edits of a large live scene cost, against Embree alone",
            addRows<measureUpdate>);
        add("pick", "what a pick costs, against osgUtil's own and one ray", addRows<measurePicks>);
        add("upsample", "what images of fewer pixels lose, and what it costs to show them",
            addUpsample);
        add("interactive", "whether the frames of a moving camera keep to their budgets",
            addInteractive);
        add("moving", "how legible views are while they move, and where their time goes",
            addMoving);
        add("denoise",
            "how much error the denoiser takes from one and four passes, and how long it takes",
            addRows<measureDenoise>);
        add("reproject", "what a moving view gains from its earlier frames, and what they cost",
            addReproject);
        add("traffic", "what a still view keeps of its samples while some cars move", addTraffic);
        add("transport", "error times time of scenes that are hard for light transport",
            addTransport);
        add("report", "error against time, of all methods on many scenes", addReport);
        add("compare", "which rows of two reports differ by more than their noise", addCompare);
        application.require_subcommand(1);
        application.set_version_flag("--version", app::versionText(kProgram),
                                     "Prints the version and exits");
    }

    int run() const
    {
        for (const auto& [mode, run] : modes)
            if (*mode) return run();
        return app::kUsage;
    }

    CLI::App application{"Speed and error of osgRayTrace."};

private:
    void add(const std::string& name, const std::string& description, Run (*addOptions)(CLI::App&))
    {
        CLI::App& mode = *application.add_subcommand(name, description);
        modes.emplace_back(&mode, addOptions(mode));
    }

    std::vector<std::pair<CLI::App*, Run>> modes;
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
