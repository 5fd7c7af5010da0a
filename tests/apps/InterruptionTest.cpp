// InterruptionTest.cpp - osgraytrace gets signals while it renders and writes.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

#include "osgPlugins/exr/ExrImage.h"

#include <nlohmann/json.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <optional>
#include <thread>

using Catch::Matchers::Contains;
using osgRayTrace::engine::ExrImage;
using osgRayTrace::engine::readExr;

namespace
{

using Names = std::vector<std::string>;

const std::string kBoxFile = OSGRAYTRACE_TEST_SOURCE "/data/cornell_box.osgt";

/// All pixels see the inside of the box.
std::vector<std::string> renderOfBox(const std::vector<std::string>& more)
{
    std::vector<std::string> arguments{OSGRAYTRACE_TEST_PROGRAM, kBoxFile, "--fovy", "20"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

struct Signal
{
    int number;
    const char* name;
    int exitCode;
};

/// A program that writes a picture into a pipe that nobody reads, so that writing never ends.
class StuckWriter
{
public:
    StuckWriter()
    {
        std::filesystem::create_directory(_folder / "tmp");
        REQUIRE(mkfifo((_folder / "pipe.png").c_str(), 0600) == 0);
        program.emplace(_folder / ".",
                        renderOfBox({"--size", "8", "8", "--passes", "1", "-o", "pipe.png"}),
                        std::vector<std::string>{"TMPDIR=" + _folder / "tmp"});
        // The temporary file shows that writing has begun.
        for (int i = 0; i < 600 && !hasRemnants(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        CHECK(hasRemnants());
    }

    bool hasRemnants() const { return !std::filesystem::is_empty(_folder / "tmp"); }

private:
    TemporaryFolder _folder;

public:
    std::optional<RunningProgram> program; ///< ends before its folder goes
};

} // namespace

TEST_CASE("osgraytrace: a signal ends the render, and what there is is written", "[apps]")
{
    for (const Signal& signal :
         {Signal{SIGINT, "SIGINT", 130}, {SIGTERM, "SIGTERM", 143}, {SIGHUP, "SIGHUP", 129}})
    {
        CAPTURE(signal.name);
        const TemporaryFolder folder;
        RunningProgram program(folder / ".",
                               renderOfBox({"--size", "64", "48", "--passes", "16777216", "-o",
                                            "x.exr", "-o", "x.png", "--stats", "s.json"}));
        REQUIRE(program.prints("pass "));
        program.signal(signal.number);
        CHECK(program.wait() == signal.exitCode);
        REQUIRE(folder.fileNames() == Names{"s.json", "x.exr", "x.png"});
        const nlohmann::json statistics = nlohmann::json::parse(contents(folder / "s.json"));
        const int passes = statistics["passes"];
        CHECK(passes > 0);
        CHECK(statistics["interrupted"] == signal.name);
        CHECK_THAT(program.printed(), Contains("osgraytrace: " + std::string(signal.name) + ": " +
                                               std::to_string(passes) + " of at most 16777216"));
        ExrImage image;
        REQUIRE(readExr(folder / "x.exr", image) == "");
        const auto& alpha = image.find("A")->values;
        CHECK(*std::min_element(alpha.begin(), alpha.end()) > 0.0f);
    }
}

// A pass of these samples takes minutes; how long loading takes before it is not known.
// Before the program handles signals, they end it without an exit code.
TEST_CASE("osgraytrace: a signal in the first pass leaves the tiles there are", "[apps]")
{
    for (int milliseconds = 250; milliseconds < 20000; milliseconds *= 2)
    {
        const TemporaryFolder folder;
        RunningProgram program(
            folder / ".",
            renderOfBox({"--size", "640", "480", "--integrator", "whitted", "--light-samples",
                         "4096", "-o", "x.exr", "--aov", "depth", "--stats", "s.json"}));
        REQUIRE(program.handles(SIGINT));
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        program.signal(SIGINT);
        CHECK(program.wait() == 130);
        if (folder.fileNames().empty()) continue; // no tile yet
        REQUIRE(folder.fileNames() == Names{"s.json", "x.exr"});
        CHECK_THAT(program.printed(), Contains("osgraytrace: SIGINT: not even the first pass"));
        const nlohmann::json statistics = nlohmann::json::parse(contents(folder / "s.json"));
        CHECK(statistics["passes"] == 0);
        const double coverage = statistics["imageShare"];
        ExrImage image;
        REQUIRE(readExr(folder / "x.exr", image) == "");
        const auto& alpha = image.find("A")->values;
        const auto& depth = image.find("depth.Z")->values;
        std::size_t covered = 0;
        for (std::size_t i = 0; i < alpha.size(); ++i)
        {
            covered += alpha[i] > 0.0f;
            if (!(alpha[i] > 0.0f)) CHECK((depth[i] == 1.0f));
        }
        CHECK(double(covered) / double(alpha.size()) == Approx(coverage).margin(1e-6));
        CHECK(coverage > 0.0);
        CHECK(coverage < 1.0);
        return;
    }
    FAIL("no tile was rendered within 20 s");
}

TEST_CASE("osgraytrace: a second signal ends it at once, without remnants", "[apps]")
{
    StuckWriter writer;
    writer.program->signal(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(100)); // two at once would be one
    writer.program->signal(SIGTERM);
    CHECK(writer.program->wait() == 143);
    CHECK_FALSE(writer.hasRemnants());
}

TEST_CASE("osgraytrace: a crash leaves no remnants", "[apps]")
{
    StuckWriter writer;
    writer.program->signal(SIGABRT);
    CHECK(writer.program->wait() == -SIGABRT);
    CHECK_FALSE(writer.hasRemnants());
}
