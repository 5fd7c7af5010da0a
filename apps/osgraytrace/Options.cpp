// Options.cpp - parses and checks the command line. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Options.h"

#include "MotionOptions.h"
#include "NumberChecks.h"
#include "OptionChecks.h"
#include "apps/common/Failure.h"
#include "apps/common/Program.h"
#include "osgRayTrace/base/NumberText.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

namespace osgRayTrace::app
{

namespace
{

constexpr int kDefaultPasses = 64;
const char* const kChannels = "depth|distance|normal|albedo|position|id|error";

const char* const kFooter =
    "Formats: .exr holds linear radiance and channels; .png and .jpg are tone mapped.\n"
    "Exit codes: 0 done, 1 usage, 2 cannot load, 3 cannot render, 4 cannot write.";

/// Holds the values of the command line before they are checked as a whole.
struct RawOptions
{
    std::vector<int> size;
    std::vector<int> crop;
    std::vector<double> eye, center, up;
    double fovyDegrees = 0.0, height = 0.0;
    std::string context;
    RawMotion motion;
    std::vector<double> sun;
    std::string headlight;
    std::string background;
};

std::string commaSeparated(std::string range)
{
    for (size_t bar = range.find('|'); bar != std::string::npos; bar = range.find('|', bar))
    {
        range.replace(bar, 1, ", ");
    }
    return range;
}

CLI::Validator oneOf(const std::string& words)
{
    const auto problem = [words](const std::string& text)
    {
        const bool good = ("|" + words + "|").find("|" + text + "|") != std::string::npos;
        return good ? std::string() : "'" + text + "' is not one of " + commaSeparated(words);
    };
    return CLI::Validator(problem, "");
}

/// Returns the pass after the last one of "B" or "A:B", and records A.
std::string endOfPasses(const std::string& value, Options& options)
{
    const std::size_t colon = value.find(':');
    options.firstPass = 0;
    if (colon == std::string::npos) return value;
    const auto first = engine::parseNumber<int>(value.substr(0, colon));
    const auto end = engine::parseNumber<int>(value.substr(colon + 1));
    if (!first || !end || *first < 0 || *end <= *first)
        throw CLI::ValidationError("--passes", "'" + value + "' is not A:B with 0 <= A < B");
    options.firstPass = *first;
    return value.substr(colon + 1);
}

/// Adds a command line option for each option of RayTraceSettings, by its name.
void addSettings(CLI::App& app, Options& options)
{
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        const bool passes = option.name == "max-passes";
        const std::string name = passes                          ? "--passes,--max-passes"
                                 : option.name == "point-radius" ? "--points,--point-radius"
                                                                 : "--" + option.name;
        const std::string help =
            passes ? "Stop after so many passes (64, unless --time or --error is given); or make "
                     "those from A to B, B excluded, and leave the others to other machines"
                   : option.help;
        const std::string range = passes ? option.range + "|A:B" : option.range;
        const auto setter = [&options, option, passes](const std::string& spelling)
        {
            return [&options, option, spelling, passes](const std::string& value)
            {
                const std::string given = passes ? endOfPasses(value, options) : value;
                options.assignments.emplace_back(option.name, given);
                if (options.settings->set(spelling, given)) return;
                throw CLI::ValidationError("--" + option.name, "'" + value + "' is not one of " +
                                                                   commaSeparated(option.range));
            };
        };
        if (!option.formerName.empty())
            app.add_option_function<std::string>("--" + option.formerName,
                                                 setter(option.formerName))
                ->group(""); // hidden from the help
        app.add_option_function<std::string>(name, setter(option.name), help)
            ->option_text(range)
            ->group("Settings");
    }
}

void addLightOptions(CLI::App& app, Options& options, RawOptions& raw)
{
    app.add_option("--environment", options.lights.environment,
                   "Image by longitude and latitude that lights the models from all around")
        ->option_text("FILE");
    app.add_option("--environment-turn", options.lights.turnDegrees,
                   "Turns it about +z, anticlockwise seen from above")
        ->option_text("DEGREES")
        ->needs("--environment")
        ->check(finite());
    app.add_option("--environment-strength", options.lights.strength, "Factor of its radiance (1)")
        ->option_text("FACTOR")
        ->needs("--environment")
        ->check(positive());
    app.add_option("--sun", raw.sun,
                   "Directional light: clockwise from +y as on a compass, and above the horizon "
                   "[degrees]; --light-angle 0.53 makes it as large as the sun")
        ->option_text("AZIMUTH ELEVATION")
        ->expected(2)
        ->check(finite());
    app.add_option("--headlight", raw.headlight,
                   "Light at the eye for models without a light 0; on, unless --environment or "
                   "--sun is given")
        ->option_text("on|off")
        ->check(oneOf("on|off"));
    app.add_option(
           "--background", raw.background,
           "Stands behind .png, .jpg and video in place of the clear colour: an image, a "
           "colour or two, each #rrggbb, black, white or gray; transparent: .png with alpha")
        ->option_text("FILE|COLOR[:COLOR]");
}

void addOptions(CLI::App& app, Options& options, RawOptions& raw)
{
    app.add_option("MODEL", options.models, "Files that OpenSceneGraph reads")->option_text("...");
    app.add_option(
           "-o,--output", options.outputs,
           "Picture to write: .exr, .png, .jpg, or video of frames: .mp4, .mov, .mkv, .webm; "
           "may be repeated")
        ->option_text("FILE")
        ->allow_extra_args(false);
    app.add_option("--size", raw.size, "Pixels (1280 720)")->option_text("W H")->expected(2);

    app.add_option("--crop", raw.crop,
                   "Renders a part of the picture alone: pixels from its left and its top, width, "
                   "height")
        ->option_text("X Y W H")
        ->expected(4);
    app.add_option("--camera", options.camera,
                   "Camera of the model, by its name; or a file of the following options, as "
                   "osgraytraceviewer's key E writes it")
        ->option_text("NAME|FILE");
    app.add_option("--eye", raw.eye, "Position of the camera")
        ->option_text("X Y Z")
        ->expected(3)
        ->check(finite());
    app.add_option("--center", raw.center, "Point that it looks at")
        ->option_text("X Y Z")
        ->expected(3)
        ->check(finite());
    app.add_option("--up", raw.up, "What is up in the picture")
        ->option_text("X Y Z")
        ->expected(3)
        ->check(finite());
    app.add_option("--fovy", raw.fovyDegrees,
                   "Vertical field of view; by default the view is osgviewer's")
        ->option_text("DEGREES")
        ->check(between(0.0, 180.0, "an angle between 0 and 180"));
    app.add_option("--parallel", raw.height,
                   "Makes the view parallel: a plan that shows so much from bottom to top")
        ->option_text("HEIGHT")
        ->excludes("--fovy")
        ->check(positive());

    addLightOptions(app, options, raw);
    addMotionOptions(app, options, raw.motion);
    app.add_option("--time", options.seconds, "Stop after so many seconds")
        ->option_text("SECONDS")
        ->check(positive());
    app.add_option("--error", options.relativeError,
                   "Stop at this estimated error, relative to the brightness of 16 x 16 pixels")
        ->option_text("RELATIVE")
        ->check(positive());

    app.add_option("--checkpoint", options.checkpoint,
                   "Keeps the passes in this file, which shows the picture, and goes on from it: "
                   "the same command begins, resumes and ends a picture")
        ->option_text("FILE.exr");
    app.add_option("--interval", options.interval, "Time between two checkpoints (60)")
        ->option_text("SECONDS")
        ->needs("--checkpoint")
        ->check(positive());
    app.add_option("--merge", options.merged,
                   "Joins checkpoints of different passes of a picture, for -o and --checkpoint; "
                   "no MODEL")
        ->option_text("FILE.exr ...");

    app.add_flag("--mpi", options.mpi,
                 "Shares the passes among the processes that mpirun or srun has started; the files "
                 "are those of one process, bit by bit");
    app.add_flag("--send-scene", options.sendsScene,
                 "Lets rank 0 alone read the models and send the scene: the others need neither "
                 "files nor plugins")
        ->needs("--mpi");

    app.add_option("--aov", options.channels, "Extra EXR channels: " + commaSeparated(kChannels))
        ->option_text("NAME,...")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(oneOf(kChannels));
    app.add_option("--reference", options.reference,
                   "Prints RMSE, relMSE and mean ratio against it")
        ->option_text("FILE.exr");
    app.add_option("--stats", options.statistics, "Writes counts, times and errors")
        ->option_text("FILE.json");
    app.add_flag("--report", options.report,
                 "Prints what was ray traced, approximated and left out, and where; needs no -o");
    app.add_flag("--names", options.names,
                 "Prints the names in the models that a file for --materials can use; needs no -o");
    app.add_option("--write-materials", options.writtenMaterials,
                   "Writes the materials of the models as a file for --materials to edit; needs no "
                   "-o, renders nothing; not beside -o, --names, --report, --stats")
        ->option_text("FILE.json");
    app.add_option(
           "--context", raw.context,
           "none, osmesa, egl; with OpenGL, OSG draws what rays do not: text, lines, shaders")
        ->option_text("NAME")
        ->check(oneOf("none|osmesa|egl"));
    app.add_flag("--list-options", options.listOptions,
                 "Prints every setting with default, range and variable");
}

osg::Vec3d vectorOf(const std::vector<double>& values)
{
    return osg::Vec3d(values[0], values[1], values[2]);
}

/// Makes the size that of a part of the picture. Throws Failure(kUsage) if it is not within.
void applyCrop(const std::vector<int>& crop, Options& options)
{
    const auto within = [](int begin, int size, int full)
    { return begin >= 0 && size >= 1 && begin < full && size <= full - begin; };
    if (!within(crop[0], crop[2], options.width) || !within(crop[1], crop[3], options.height))
        throw Failure(kUsage, "--crop: X Y W H is not within the picture of --size");
    options.crop = Crop{crop[0], crop[1], options.width, options.height};
    options.width = crop[2];
    options.height = crop[3];
}

void applyRaw(const CLI::App& app, const RawOptions& raw, Options& options)
{
    if (!raw.size.empty())
    {
        options.width = raw.size[0];
        options.height = raw.size[1];
    }
    if (!raw.crop.empty()) applyCrop(raw.crop, options);
    if (!raw.eye.empty()) options.view.eye = vectorOf(raw.eye);
    if (!raw.center.empty()) options.view.center = vectorOf(raw.center);
    if (!raw.up.empty()) options.view.up = vectorOf(raw.up);
    if (app.count("--fovy")) options.view.fovyDegrees = raw.fovyDegrees;
    if (app.count("--parallel")) options.view.height = raw.height;
    applyMotion(app, raw.motion, options);
    if (!raw.sun.empty())
    {
        if (std::abs(raw.sun[1]) > 90.0)
            throw Failure(kUsage, "--sun: the elevation is from -90 to 90 degrees");
        options.lights.sun = SceneLights::Sun{raw.sun[0], raw.sun[1]};
    }
    if (!raw.headlight.empty()) options.lights.headlight = raw.headlight == "on";
    options.backdrop = readBackdrop(raw.background);
    if (raw.context == "osmesa") options.context = Context::OsMesa;
    if (raw.context == "egl") options.context = Context::Egl;
}

/// Sets the default of 64 passes unless another option says when to stop; the default is 1 if a
/// report is wanted without a picture.
void applyPasses(const CLI::App& app, Options& options)
{
    if (app.count("--passes") || std::getenv("OSGRAYTRACE_MAX_PASSES")) return;
    const bool otherwiseLimited = options.seconds > 0.0 || options.relativeError > 0.0;
    const bool reportAlone = options.report && options.outputs.empty();
    options.defaultPasses = otherwiseLimited ? 1 << 24 : reportAlone ? 1 : kDefaultPasses;
    options.settings->setMaxPasses(*options.defaultPasses);
}

} // namespace

std::optional<Options> parseOptions(int argc, char** argv)
{
    Options options;
    options.settings = new RayTraceSettings;
    const bool merges = std::find(argv, argv + argc, std::string("--merge")) != argv + argc;
    if (!merges) options.lights.readVariables(argc, argv); // parts have their light already
    RawOptions raw;

    CLI::App app("Ray traces OpenSceneGraph models to pictures, without a graphics context.",
                 "osgraytrace");
    app.footer(kFooter);
    app.set_version_flag("--version", versionText("osgraytrace"), "Prints the version and exits");
    addOptions(app, options, raw);
    addSettings(app, options);
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::CallForHelp&)
    {
        std::cout << app.help();
        return std::nullopt;
    }
    catch (const CLI::CallForVersion& version)
    {
        std::cout << version.what() << '\n';
        return std::nullopt;
    }
    catch (const CLI::ParseError& error)
    {
        throw Failure(kUsage, error.what());
    }

    if (options.listOptions) return options;
    applyRaw(app, raw, options);
    applyPasses(app, options);
    checkOptions(options);
    return options;
}

std::string optionTable()
{
    using Row = std::vector<std::string>;
    std::vector<Row> rows{{"option", "default", "range", "environment variable", "meaning"}};
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        rows.push_back({"`" + option.name + "`", option.defaultValue, commaSeparated(option.range),
                        "`" + option.environment + "`", option.help});
    }

    Row rule;
    std::vector<size_t> widths;
    for (size_t column = 0; column < rows[0].size(); ++column)
    {
        size_t width = 0;
        for (const Row& row : rows)
        {
            width = std::max(width, row[column].size());
        }
        widths.push_back(width);
        rule.push_back(std::string(width, '-'));
    }
    rows.insert(rows.begin() + 1, rule);

    std::string table;
    for (const Row& row : rows)
    {
        for (size_t column = 0; column < row.size(); ++column)
        {
            table += "| " + row[column] + std::string(widths[column] - row[column].size() + 1, ' ');
        }
        table += "|\n";
    }
    return table;
}

} // namespace osgRayTrace::app
