// PictureTest.cpp - the pictures and messages that osgraytrace writes.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/VolumeTiles.h"
#include "tests/apps/ComparedPictures.h"
#include "tests/apps/Program.h"

#include <osgRayTrace/RayTraceSettings>

#include <osg/ShapeDrawable>
#include <osgDB/WriteFile>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>

using Catch::Matchers::Contains;
using osgRayTrace::RayTraceSettings;
using osgRayTrace::engine::ExrImage;
using osgRayTrace::engine::readExr;

namespace
{

const std::string kBox = dataFile("cornell_box.osgt");
const std::string kQuick = " --size 64 48 --passes 4 ";

struct Measures
{
    double rmse = -1.0;
    double relMse = -1.0;
    double meanRatio = -1.0;
};

Measures measuresIn(const std::string& output)
{
    Measures measures;
    const size_t begin = output.find("RMSE ");
    if (begin == std::string::npos) return measures;
    std::sscanf(output.c_str() + begin, "RMSE %lf relMSE %lf mean ratio %lf", &measures.rmse,
                &measures.relMse, &measures.meanRatio);
    return measures;
}

/// Compares bytes without a comparison of strings, which a failure would print.
bool sameBytes(const std::string& a, const std::string& b)
{
    return !contents(a).empty() && contents(a) == contents(b);
}

nlohmann::json statistics(const TemporaryFolder& folder)
{
    return nlohmann::json::parse(contents(folder / "s.json"));
}

/// Writes a model that is lit by the headlight alone, before a background of osgviewer's blue.
void writeFixedFunctionModel(const std::string& file)
{
    osg::ref_ptr<osg::ShapeDrawable> sphere =
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f));
    sphere->setColor(osg::Vec4(0.8f, 0.4f, 0.2f, 1.0f));
    osgDB::writeNodeFile(*sphere, file);
}

} // namespace

TEST_CASE("osgraytrace: one render, several files of each kind", "[apps]")
{
    const TemporaryFolder folder;
    const Outcome outcome =
        osgraytrace(folder, kBox + kQuick + "-o a.exr -o b.png -o c.jpg -o d.EXR");
    CHECK(outcome.exitCode == 0);
    CHECK(outcome.errors.empty()); // no progress bar, as this is no terminal
    CHECK_THAT(outcome.output, Contains("path, 4 passes"));
    CHECK(folder.fileNames() == std::vector<std::string>{"a.exr", "b.png", "c.jpg", "d.EXR"});
    CHECK(sameBytes(folder / "a.exr", folder / "d.EXR"));
    CHECK(contents(folder / "b.png").substr(0, 8) == "\x89PNG\r\n\x1a\n");
    CHECK(contents(folder / "c.jpg").substr(0, 3) == "\xff\xd8\xff");
}

TEST_CASE("osgraytrace: a terminal sees a progress bar", "[apps]")
{
    const TemporaryFolder folder;
    const std::string command = "cd '" + folder / "." + "' && TERM=xterm script -qec \"'" +
                                OSGRAYTRACE_TEST_PROGRAM "' " + kBox + kQuick +
                                "-o x.png\" typescript >/dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    CHECK_THAT(contents(folder / "typescript"), Contains("\r[#") && Contains("M rays/s"));
    CHECK(!contents(folder / "x.png").empty());
}

TEST_CASE("osgraytrace: EXR channels are those asked for", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder,
                        kBox + kQuick +
                            "-o x.exr --aov depth,normal --aov id,albedo,position,error,distance")
                .exitCode == 0);
    ExrImage exr;
    REQUIRE(readExr(folder / "x.exr", exr) == "");
    CHECK(exr.width == 64);
    CHECK(exr.height == 48);
    CHECK(exr.channels.size() == 4 + 1 + 3 + 1 + 3 + 3 + 3 + 1);
    for (const char* name : {"R", "G", "B", "A", "depth.Z", "normal.X", "id.I", "albedo.G",
                             "position.Y", "error.B", "distance.Z"})
    {
        CAPTURE(name);
        CHECK(exr.find(name));
    }

    // The lower edge of the picture shows the floor's white: its normal is +z, its albedo 0.73.
    const size_t pixel = 2 * 64 + 32;
    CHECK(exr.find("normal.Z")->values[pixel] == Approx(1.0f).margin(1e-5));
    CHECK(exr.find("albedo.R")->values[pixel] == Approx(0.73f));
    CHECK(exr.find("position.Z")->values[pixel] == Approx(0.0f).margin(1e-3));
    CHECK(exr.find("id.I")->values[pixel] >= 1.0f);
    CHECK(exr.find("depth.Z")->values[pixel] > 0.0f);
    CHECK(exr.find("depth.Z")->values[pixel] < 1.0f);
    CHECK(exr.find("error.R")->values[pixel] > 0.0f);
}

// The grids are those of the paper's Figures 1 to 3. Errors differ by factors of 1.2 and more from
// one strategy to the next; over the 19,200 pixels they vary by some 2 %.
TEST_CASE("osgraytrace: on the grids Sobol points have the least error, random ones the most",
          "[apps][long]")
{
    const TemporaryFolder folder;
    const std::string grids =
        dataFile("grids.osgt") + " --integrator whitted --light-samples 16 --size 160 120 ";
    REQUIRE(osgraytrace(folder, grids + "--passes 128 -o r.exr").exitCode == 0);
    const auto error = [&](const std::string& strategy)
    {
        const Outcome outcome =
            osgraytrace(folder, grids + "--passes 4 --seed 5 --light-sampling " + strategy +
                                    " -o x.exr --reference r.exr");
        REQUIRE(outcome.exitCode == 0);
        return measuresIn(outcome.output).relMse;
    };
    const double random = error("random"), jitter = error("uniform-jitter");
    const double stratified = error("stratified"), sobol = error("sobol");
    CAPTURE(random, jitter, stratified, sobol);
    CHECK(jitter < random);
    CHECK(stratified < jitter);
    CHECK(sobol < stratified);
}

TEST_CASE("osgraytrace: --reference compares with a file of the same picture", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, kBox + kQuick + "-o r.exr").exitCode == 0);
    const Measures same =
        measuresIn(osgraytrace(folder, kBox + kQuick + "-o x.png --reference r.exr").output);
    CHECK(same.rmse == 0.0);
    CHECK(same.relMse == 0.0);
    CHECK(same.meanRatio == 1.0);

    // Another seed gives other noise, but the same mean. The light is a few bright pixels, whose
    // edges cause most of the mean's noise: over 300 seeds its standard deviation is 2.7 %, so 4
    // sigma of a ratio are 15 %.
    const Outcome other =
        osgraytrace(folder, kBox + kQuick + "--seed 7 -o x.exr --reference r.exr --stats s.json");
    const Measures noise = measuresIn(other.output);
    CHECK(noise.rmse > 0.001);
    CHECK(noise.relMse > 0.0001);
    CHECK(noise.meanRatio == Approx(1.0).epsilon(0.15));

    ExrImage picture, reference;
    REQUIRE(readExr(folder / "x.exr", picture) == "");
    REQUIRE(readExr(folder / "r.exr", reference) == "");
    double relMse = 0.0;
    for (const char* name : {"R", "G", "B"})
    {
        const auto& x = picture.find(name)->values;
        const auto& r = reference.find(name)->values;
        for (size_t i = 0; i < x.size(); ++i)
        {
            relMse += std::pow(x[i] - r[i], 2.0) / (double(r[i]) * r[i] + 0.01) / (3.0 * x.size());
        }
    }
    CHECK(noise.relMse == Approx(relMse).epsilon(1e-4));
    CHECK(statistics(folder)["reference"]["relMse"].get<double>() == Approx(relMse).epsilon(1e-4));
}

TEST_CASE("osgraytrace: --stats counts what was done", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, kBox + " " + kBox + kQuick + "-o x.png --stats s.json").exitCode ==
            0);
    const nlohmann::json json = statistics(folder);
    CHECK(json["models"].size() == 2);
    CHECK(json["width"] == 64);
    CHECK(json["height"] == 48);
    CHECK(json["triangles"] == 2 * 38);
    CHECK(json["instances"] == 2 * 19);
    CHECK(json["integrator"] == "path");
    CHECK(json["passes"] == 4);
    CHECK(json["droppedSamples"] == 0);
    CHECK(json["rays"]["camera"] == 64 * 48 * 4);
    CHECK(json["rays"]["shadow"].get<uint64_t>() > 0);
    CHECK(json["rays"]["total"] == json["rays"]["camera"].get<uint64_t>() +
                                       json["rays"]["shadow"].get<uint64_t>() +
                                       json["rays"]["secondary"].get<uint64_t>());
    CHECK(json["renderSeconds"].get<double>() > 0.0);
    CHECK(json["buildSeconds"].get<double>() > 0.0);
    CHECK(json["convertSeconds"].get<double>() > 0.0);
    CHECK(json["relativeError"].get<double>() > 0.0);
    CHECK(json["medianError"].get<double>() > 0.0);
    CHECK(json["worstErrorShare"].get<double>() > 0.0);
    CHECK(json["worstErrorShare"].get<double>() < 1.0);
    CHECK(json["conversion"]["converted.area-light"] == 2);

    // The memory of photons is stated for all passes that are kept, and for this view.
    REQUIRE(osgraytrace(folder, kBox + " --size 32 32 --passes 3 --integrator ppm --photons 3000 "
                                       "--photon-radius 1e9 -o x.png --stats s.json")
                .exitCode == 0);
    const nlohmann::json photons = statistics(folder)["photons"];
    CHECK(photons["stored"].get<uint64_t>() > 1000);
    CHECK(photons["bytes"].get<uint64_t>() > 3 * 40 * 1000);
    CHECK(photons["hitPointBytes"].get<uint64_t>() > 32 * 32 * 50);
    CHECK(photons["note"].get<std::string>().find("photon-radius is limited") == 0);
    // The camera rays are those of the first pass of each half: the third pass shares the first
    // one's camera paths.
    CHECK(statistics(folder)["rays"]["camera"] == 2 * 32 * 32);

    // One pass has no error estimate: it is null, which every JSON reader accepts.
    REQUIRE(osgraytrace(folder, kBox + " --size 8 8 --passes 1 -o x.png --stats s.json").exitCode ==
            0);
    CHECK(statistics(folder)["relativeError"].is_null());
    CHECK(statistics(folder)["medianError"].is_null());
}

TEST_CASE("osgraytrace: stops at passes, seconds or error, whichever comes first", "[apps][long]")
{
    const TemporaryFolder folder;
    const std::string write = " --size 32 32 -o x.png --stats s.json ";
    REQUIRE(osgraytrace(folder, kBox + write).exitCode == 0);
    CHECK(statistics(folder)["passes"] == 64);

    REQUIRE(osgraytrace(folder, kBox + write, "OSGRAYTRACE_MAX_PASSES=3").exitCode == 0);
    CHECK(statistics(folder)["passes"] == 3);

    REQUIRE(osgraytrace(folder, kBox + write + "--error 0.02").exitCode == 0);
    CHECK(statistics(folder)["passes"].get<int>() > 2);
    CHECK(statistics(folder)["relativeError"].get<double>() <= 0.02);

    REQUIRE(osgraytrace(folder, kBox + write + "--error 1e-9 --passes 5").exitCode == 0);
    CHECK(statistics(folder)["passes"] == 5);

    // However short the time is, at least one tile of four is traced; the limit of 64 passes does
    // not apply if there is a time.
    const Outcome part = osgraytrace(folder, kBox + write + "--threads 1 --time 1e-6");
    REQUIRE(part.exitCode == 0);
    CHECK_THAT(part.output,
               Contains("0 passes") &&
                   Contains("25 % of the first one, the rest of the picture is missing"));
    CHECK(statistics(folder)["passes"] == 0);
    CHECK(statistics(folder)["imageShare"] == 0.25);
    CHECK(contents(folder / "x.png").size() > 100);
    REQUIRE(osgraytrace(folder, kBox + write + "--time 3600 --error 0.005").exitCode == 0);
    CHECK(statistics(folder)["passes"].get<int>() > 64);
    CHECK(statistics(folder)["relativeError"].get<double>() <= 0.005);
}

TEST_CASE("osgraytrace: the same picture for any number of threads", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, kBox + kQuick + "--threads 1 -o a.exr").exitCode == 0);
    REQUIRE(osgraytrace(folder, kBox + kQuick + "--threads 2 -o b.exr").exitCode == 0);
    REQUIRE(osgraytrace(folder, kBox + kQuick + "--threads 5 -o c.exr").exitCode == 0);
    CHECK(sameBytes(folder / "a.exr", folder / "b.exr"));
    CHECK(sameBytes(folder / "a.exr", folder / "c.exr"));
}

TEST_CASE("osgraytrace: the same picture with OSMesa, EGL and no context", "[apps][long][gl]")
{
    const TemporaryFolder folder;
    writeFixedFunctionModel(folder / "sphere.osgt");
    for (const std::string& model : {kBox, std::string("sphere.osgt"), dataFile("grids.osgt")})
    {
        CAPTURE(model);
        REQUIRE(osgraytrace(folder, model + kQuick + "-o none.exr -o none.png").exitCode == 0);
        REQUIRE(osgraytrace(folder, model + kQuick + "--context osmesa -o osmesa.exr -o osmesa.png")
                    .exitCode == 0);
        REQUIRE(
            osgraytrace(folder, model + kQuick + "--context egl -o egl.exr -o egl.png").exitCode ==
            0);
        CHECK(differByRounding(folder / "none.exr", folder / "osmesa.exr"));
        CHECK(sameBytes(folder / "egl.exr", folder / "osmesa.exr"));
        CHECK(sameBytes(folder / "none.png", folder / "osmesa.png"));
        CHECK(sameBytes(folder / "none.png", folder / "egl.png"));
    }
}

TEST_CASE("osgraytrace: a view stored in the scene is the default, options replace it", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, kBox + kQuick + "-o stored.exr").exitCode == 0);
    const std::string published = "--eye -278 -800 278 --center -278 0 278 --up 0 0 1 --fovy 39.3 ";
    const Measures same = measuresIn(
        osgraytrace(folder, kBox + kQuick + published + "-o x.exr --reference stored.exr").output);
    CHECK(same.meanRatio == Approx(1.0).epsilon(0.01));
    CHECK(same.relMse < 0.001);

    const Measures other = measuresIn(
        osgraytrace(folder, kBox + kQuick + "--eye -278 -1600 278 -o x.exr --reference stored.exr")
            .output);
    CHECK(other.relMse > 0.1);
}

TEST_CASE("osgraytrace: the furnace is 1 everywhere", "[apps][statistics]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, dataFile("furnace.osgt") +
                                    " --size 32 32 --passes 64 --max-bounces 40 -o x.exr")
                .exitCode == 0);
    ExrImage exr;
    REQUIRE(readExr(folder / "x.exr", exr) == "");
    double mean = 0.0;
    for (const float value : exr.find("G")->values)
    {
        mean += value / (32.0 * 32.0);
    }
    // A path's radiance varies by less than 1: the mean of 65536 paths is right to 0.004 at one
    // sigma.
    CHECK(mean == Approx(1.0).margin(0.016));
}

TEST_CASE("osgraytrace: --list-options names every setting, and the page of settings shows it",
          "[apps]")
{
    const TemporaryFolder folder;
    const Outcome outcome = osgraytrace(folder, "--list-options");
    REQUIRE(outcome.exitCode == 0);
    for (const RayTraceSettings::Option& option : RayTraceSettings::options())
    {
        CHECK_THAT(outcome.output, Contains("`" + option.name + "`") &&
                                       Contains(option.environment) &&
                                       Contains(option.defaultValue) && Contains(option.help));
    }
    CHECK_THAT(contents(OSGRAYTRACE_TEST_SOURCE "/osgRayTrace/docs/settings.md"),
               Contains(outcome.output));
}

TEST_CASE("osgraytrace: --help names every option of the command line", "[apps]")
{
    const TemporaryFolder folder;
    const Outcome outcome = osgraytrace(folder, "--help");
    CHECK(outcome.exitCode == 0);
    for (const char* option :
         {"--size", "--integrator", "--light-samples", "--light-sampling", "--passes",
          "--time", "--error",      "--eye",           "--center",         "--up",
          "--fovy", "--exposure",   "--max-bounces",   "--seed",           "--threads",
          "--aov",  "--reference",  "--stats",         "--context",        "--list-options"})
    {
        CHECK_THAT(outcome.output, Contains(option));
    }
}

TEST_CASE("app: an EXR file says how its picture was made", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, kBox + kQuick + "--seed 5 --integrator path --fovy 30 -o a.exr")
                .exitCode == 0);
    const auto textOf = [header = contents(folder / "a.exr")](const std::string& name)
    {
        // An attribute is its name and its type, each with a zero behind it, its size and its
        // value.
        const std::string begin = "osgRayTrace." + name + std::string("\0string\0", 8);
        const std::size_t at = header.find(begin);
        std::uint32_t size = 0;
        if (at == std::string::npos) return std::string();
        std::memcpy(&size, header.data() + at + begin.size(), sizeof size);
        return header.substr(at + begin.size() + sizeof size, size);
    };
    CHECK(textOf("integrator") == "path");
    CHECK(textOf("passes") == "4");
    CHECK(textOf("seed") == "5");
    CHECK(std::stod(textOf("error")) > 0.0);

    // The camera is written as options: they make the same picture, except for rounding.
    const Outcome again = osgraytrace(
        folder, kBox + kQuick + "--seed 5 --integrator path -o b.exr --reference a.exr " +
                    textOf("camera"));
    INFO(textOf("camera") << again.errors);
    CHECK(measuresIn(again.output).rmse >= 0.0);
    CHECK(measuresIn(again.output).rmse < 1e-3);
}

TEST_CASE("app: a crop has the pixels of its place in the picture", "[apps]")
{
    const TemporaryFolder folder;
    const std::string common = kBox + " --passes 1 --aov distance,position -o ";
    REQUIRE(osgraytrace(folder, common + "whole.exr --size 64 48").exitCode == 0);
    REQUIRE(osgraytrace(folder, common + "part.exr --size 64 48 --crop 10 5 20 30").exitCode == 0);
    ExrImage whole, part;
    REQUIRE(readExr(folder / "whole.exr", whole).empty());
    REQUIRE(readExr(folder / "part.exr", part).empty());
    REQUIRE((part.width == 20 && part.height == 30));
    for (const char* name : {"distance.Z", "position.X", "position.Z"})
    {
        INFO(name);
        for (int y = 0; y < 30; ++y) // rows from the top; row 0 of an image is at the bottom
            for (int x = 0; x < 20; ++x)
            {
                const float value = whole.find(name)->values[size_t(64 * (47 - 5 - y) + 10 + x)];
                const float cropped = part.find(name)->values[size_t(20 * (29 - y) + x)];
                REQUIRE((value == cropped || std::abs(value - cropped) < 0.02f)); // of 560
            }
    }
    for (const char* wrong : {"60 0 5 5", "-1 0 5 5", "0 0 0 5", "0 44 5 5"})
        CHECK(osgraytrace(folder, common + "no.exr --size 64 48 --crop " + wrong).exitCode == 1);
}

TEST_CASE("osgraytrace: a volume alone is a picture", "[apps]")
{
    const TemporaryFolder folder, models;
    const osg::ref_ptr<osgVolume::VolumeTile> tile = osgRayTrace::test::tileOf(
        osgRayTrace::test::ballImage(16), osgRayTrace::test::blueToYellow(0.9f).get(),
        new osgVolume::RayTracedTechnique, osg::Matrixd::scale(2.0, 2.0, 2.0));
    REQUIRE(osgDB::writeNodeFile(*tile, models / "tile.osgt"));
    const Outcome outcome = osgraytrace(folder, models / "tile.osgt" + kQuick + "-o x.exr");
    CHECK(outcome.exitCode == 0);
    CHECK_THAT(outcome.output, Contains("estimated error"));
    ExrImage image;
    REQUIRE(readExr(folder / "x.exr", image) == "");
    const std::vector<float>& green = image.find("G")->values;
    CHECK(*std::max_element(green.begin(), green.end()) > 0.1f);
}
