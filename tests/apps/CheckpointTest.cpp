// CheckpointTest.cpp - osgraytrace makes a picture in parts, and goes on after any end.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

#include "osgPlugins/exr/ExrImage.h"

#include <random>
#include <thread>

using Catch::Matchers::Contains;
using osgRayTrace::engine::ExrImage;
using osgRayTrace::engine::readExr;

namespace
{

using Names = std::vector<std::string>;

const std::string kView = " --light-samples 1 ";
const std::string kSize = " --fovy 20 --size 40 24 ";

std::string renderOf(const std::string& more, const std::string& size = kSize)
{
    return dataFile("cornell_box.osgt") + kView + size + more;
}

/// Returns the same arguments, one by one.
std::vector<std::string> wordsOf(const std::string& more)
{
    std::vector<std::string> words{OSGRAYTRACE_TEST_PROGRAM,
                                   OSGRAYTRACE_TEST_SOURCE "/data/cornell_box.osgt"};
    std::istringstream stream(kView + kSize + more);
    for (std::string word; stream >> word;)
        words.push_back(word);
    return words;
}

/// Writes a file without its last bytes.
void truncate(const std::string& from, const std::string& to, std::size_t bytes)
{
    const std::string text = contents(from).substr(0, bytes);
    std::ofstream(to, std::ios::binary) << text;
}

} // namespace

TEST_CASE("checkpoint: parts in any order are the picture of one machine, file by file",
          "[apps][long]")
{
    for (const std::string integrator : {"path", "sppm"})
    {
        CAPTURE(integrator);
        const TemporaryFolder folder;
        const std::string options = "--integrator " + integrator + " --photons 2000 ";
        REQUIRE(osgraytrace(folder, renderOf(options + "--passes 12 --checkpoint whole.exr "
                                                       "-o whole_picture.exr -o whole.png"))
                    .exitCode == 0);
        for (const std::string part : {"0:3", "3:8", "8:12"})
        {
            const Outcome outcome =
                osgraytrace(folder, renderOf(options + "--passes " + part + " --checkpoint part" +
                                             part.substr(0, 1) + ".exr --threads " +
                                             std::to_string(1 + part[0] % 3)));
            CAPTURE(outcome.errors);
            REQUIRE(outcome.exitCode == 0);
        }
        const Outcome merged =
            osgraytrace(folder, "--merge part8.exr part0.exr part3.exr --checkpoint merged.exr "
                                "-o merged_picture.exr -o merged.png");
        CAPTURE(merged.errors);
        REQUIRE(merged.exitCode == 0);
        CHECK_THAT(merged.output, Contains("12 passes: 0-11"));
        CHECK((contents(folder / "merged.exr") == contents(folder / "whole.exr")));
        CHECK((contents(folder / "merged.png") == contents(folder / "whole.png")));
        CHECK((contents(folder / "merged_picture.exr") == contents(folder / "whole_picture.exr")));

        ExrImage shown, picture;
        REQUIRE(readExr(folder / "whole.exr", shown, {"R", "G", "B", "A"}) == "");
        REQUIRE(readExr(folder / "whole_picture.exr", picture, {"R", "G", "B", "A"}) == "");
        REQUIRE(shown.channels.size() == 4);
        for (const auto& channel : picture.channels)
            CHECK(shown.find(channel.name)->values == channel.values);
    }
}

TEST_CASE("checkpoint: fog before nothing is merged as it is rendered", "[apps]")
{
    const TemporaryFolder folder;
    const std::string options = dataFile("cornell_box_fog.osgt") + " --fovy 90 --size 24 16 ";
    REQUIRE(
        osgraytrace(folder, options + "--passes 2 --checkpoint whole.exr -o whole.png").exitCode ==
        0);
    for (const std::string part : {"0:1", "1:2"})
        REQUIRE(osgraytrace(folder, options + "--passes " + part + " --checkpoint part" +
                                        part.substr(0, 1) + ".exr")
                    .exitCode == 0);
    REQUIRE(osgraytrace(folder, "--merge part0.exr part1.exr --checkpoint merged.exr -o merged.png")
                .exitCode == 0);
    CHECK((contents(folder / "merged.exr") == contents(folder / "whole.exr")));
    CHECK((contents(folder / "merged.png") == contents(folder / "whole.png")));
}

TEST_CASE("checkpoint: the same command goes on after it was killed", "[apps][long]")
{
    const TemporaryFolder folder;
    const std::string options =
        "--integrator photon-caustics --photons 2000 --passes 400 --interval 0.01 ";
    REQUIRE(osgraytrace(folder, renderOf(options + "--checkpoint whole.exr")).exitCode == 0);
    std::mt19937 random(5);
    bool cut = false;
    for (int kills = 0; kills < 20; ++kills)
    {
        RunningProgram program(folder / ".", wordsOf(options + "--checkpoint x.exr"));
        REQUIRE(program.handles(SIGINT));
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 300));
        program.signal(SIGKILL);
        if (program.wait() == 0) break;
        ExrImage image;
        if (!std::filesystem::exists(folder / "x.exr")) continue;
        cut = true;
        REQUIRE(readExr(folder / "x.exr", image) == ""); // whole at any time
    }
    CHECK(cut);
    const Outcome last = osgraytrace(folder, renderOf(options + "--checkpoint x.exr"));
    CAPTURE(last.errors);
    REQUIRE(last.exitCode == 0);
    CHECK_THAT(last.errors, Contains("x.exr: goes on from passes 0-"));
    CHECK((contents(folder / "x.exr") == contents(folder / "whole.exr")));
}

TEST_CASE("checkpoint: a signal ends with the pass at work, and says how to go on", "[apps]")
{
    for (const auto& [number, name, code] :
         {std::tuple(SIGUSR1, "SIGUSR1", 138), {SIGTERM, "SIGTERM", 143}})
    {
        CAPTURE(name);
        const TemporaryFolder folder;
        RunningProgram program(
            folder / ".", wordsOf("--passes 16777216 --checkpoint x.exr --interval 1000 -o x.png"));
        REQUIRE(program.prints("pass "));
        program.signal(number);
        CHECK(program.wait() == code);
        CHECK_THAT(program.printed(), Contains(std::string(name) + ": ") &&
                                          Contains("the same command goes on from x.exr"));
        REQUIRE(folder.fileNames() == Names{"x.exr", "x.png"});
        const Outcome merged = osgraytrace(folder, "--merge x.exr -o y.png");
        CHECK(merged.exitCode == 0);
        CHECK((contents(folder / "x.png") == contents(folder / "y.png")));
    }
}

TEST_CASE("checkpoint: other pictures are refused by what differs", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, renderOf("--passes 0:2 --checkpoint a.exr")).exitCode == 0);
    const std::string before = contents(folder / "a.exr");
    const std::pair<std::string, const char*> others[] = {
        {renderOf("--seed 1 "), "seed 0, and seed 1"},
        {renderOf("--integrator whitted "), "integrator auto, and integrator whitted"},
        {renderOf("", " --fovy 21 --size 40 24 "), "projection"},
        {renderOf("", " --fovy 20 --size 24 40 "), "size 40 24, and size 24 40"},
        {renderOf("--color-rule display-referred "), "scene"}};
    for (const auto& [arguments, reason] : others)
    {
        CAPTURE(arguments);
        const Outcome other = osgraytrace(folder, arguments + "--passes 4 --checkpoint a.exr");
        CHECK(other.exitCode == 3);
        CHECK_THAT(other.errors, Contains(reason));
        CHECK((contents(folder / "a.exr") == before));
    }
    REQUIRE(osgraytrace(folder, renderOf("--passes 1:3 --checkpoint b.exr")).exitCode == 0);
    const Outcome common = osgraytrace(folder, "--merge a.exr b.exr -o x.png");
    CHECK(common.exitCode == 2);
    CHECK_THAT(common.errors, Contains("both have pass 1"));
    CHECK_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_CASE("checkpoint: damaged files are refused", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, renderOf("--passes 2 --checkpoint a.exr -o plain.exr")).exitCode ==
            0);
    const std::size_t size = contents(folder / "a.exr").size();
    std::mt19937 random(9);
    for (int i = 0; i < 20; ++i)
    {
        truncate(folder / "a.exr", folder / "cut.exr", i == 0 ? 0 : random() % size);
        const Outcome outcome = osgraytrace(folder, "--merge cut.exr -o x.png");
        CAPTURE(i, outcome.errors);
        CHECK(outcome.exitCode == 2);
    }
    const Outcome plain = osgraytrace(folder, renderOf("--passes 4 --checkpoint plain.exr"));
    CHECK(plain.exitCode == 2);
    CHECK_THAT(plain.errors, Contains("no checkpoint"));
    CHECK(osgraytrace(folder, "--merge missing.exr -o x.png").exitCode == 2);
    CHECK_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_CASE("checkpoint: options that exclude each other are named", "[apps][long]")
{
    const TemporaryFolder folder;
    const std::pair<std::string, const char*> cases[] = {
        {renderOf("--passes 4:4 -o x.png"), "0 <= A < B"},
        {renderOf("--passes a:4 -o x.png"), "0 <= A < B"},
        {renderOf("--checkpoint x.png"), "ends in .exr"},
        {renderOf("--checkpoint x.exr -o x.exr"), "the same file"},
        {renderOf("--interval 3 -o x.exr"), "--checkpoint"},
        {renderOf("--checkpoint x.exr --context osmesa"), "--context"},
        {renderOf("--checkpoint x.exr --frames 0:1 -o %d.png"), "--frames"},
        {renderOf("--checkpoint x.exr --radius-schedule local --integrator sppm"),
         "each pass depends on all before"},
        {"--merge x.exr", "--merge needs -o or --checkpoint"},
        {"--merge x.exr -o x.png --report", "--report"},
        {"--merge x.exr -o x.png --denoise filter", "--merge excludes --denoise"},
        {"--merge x.exr -o x.png --context osmesa", "--merge excludes --context"},
        {"--merge x.exr -o x.png --names", "--merge excludes --names"},
        {"--merge x.exr -o x.png --crop 0 0 4 4", "--merge excludes --crop"},
        {"--merge x.exr -o x.png --sun 0 30", "--merge excludes lights"},
        {"--merge x.exr -o %d.png --frames 0:1", "--merge excludes --frames"},
        {"--merge x.exr -o x.png --reference x.exr", "--merge excludes --reference"},
        {renderOf("--checkpoint x.exr --write-materials x.json"),
         "--write-materials excludes --checkpoint"}};
    for (const auto& [arguments, reason] : cases)
    {
        CAPTURE(arguments);
        const Outcome outcome = osgraytrace(folder, arguments);
        CHECK(outcome.exitCode == 1);
        CHECK_THAT(outcome.errors, Contains(reason));
        CHECK(folder.fileNames().empty());
    }
}

TEST_CASE("checkpoint: one that cannot be written does not cost the picture", "[apps]")
{
    // 40 x 24 pixels take 79 KiB of sums, and the limit is 8 KiB.
    const TemporaryFolder folder;
    const Outcome outcome = osgraytrace(folder, renderOf("--passes 2 --checkpoint a.exr -o a.png"),
                                        "trap '' XFSZ && ulimit -f 8 &&");
    CHECK(outcome.exitCode == 4);
    CHECK_THAT(outcome.errors, Contains("cannot write a.exr: File too large"));
    CHECK(folder.fileNames() == Names{"a.png"});
}

TEST_CASE("checkpoint: each start makes a pass at least, however short its time", "[apps]")
{
    // Photons of all passes depend on the first sixteen, which a part has to trace, too.
    const TemporaryFolder folder;
    const std::string arguments =
        renderOf("--integrator sppm --photons 2000 --passes 20:22 --checkpoint a.exr --time 1e-6");
    for (const char* passes : {"20", "20-21"})
    {
        const Outcome outcome = osgraytrace(folder, arguments);
        CAPTURE(outcome.errors);
        CHECK(outcome.exitCode == 0);
        CHECK_THAT(osgraytrace(folder, "--merge a.exr -o a.png").output,
                   Contains(std::string("passes: ") + passes));
    }
}

TEST_CASE("checkpoint: pipes and compressed files are none", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(std::system(("mkfifo '" + folder / "pipe.exr" + "'").c_str()) == 0);
    const Outcome pipe = osgraytrace(folder, "--merge pipe.exr -o x.png");
    CHECK(pipe.exitCode == 2);
    CHECK_THAT(pipe.errors, Contains("is a pipe"));
    REQUIRE(osgraytrace(folder, renderOf("--passes 1 -o plain.exr")).exitCode == 0);
    const Outcome plain = osgraytrace(folder, "--merge plain.exr -o x.png");
    CHECK(plain.exitCode == 2);
    CHECK_THAT(plain.errors, Contains("is compressed, as no checkpoint is"));
}
