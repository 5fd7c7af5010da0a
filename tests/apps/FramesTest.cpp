// FramesTest.cpp - animations as numbered files, and models at a time. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/FlyingBall.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

namespace
{

/// Writes a ball that flies from x = -6 to 6 within two seconds over a box that stands.
void writeBall(const TemporaryFolder& folder)
{
    writeBall(folder, {{0.0, -6.0}, {2.0, 6.0}}, 1.0f);
}

} // namespace

TEST_CASE("osgraytrace --at: a model is shown at a time", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    for (const char* time : {"0", "1", "2", "7"})
        REQUIRE(
            osgraytrace(folder, kQuickBall + "--at " + time + " -o " + time + ".png").exitCode ==
            0);
    REQUIRE(osgraytrace(folder, kQuickBall + "-o none.png").exitCode == 0);
    CHECK((contents(folder / "none.png") == contents(folder / "0.png")));
    CHECK((contents(folder / "7.png") == contents(folder / "2.png"))); // the path has ended
    const double first = ballIn(folder / "0.png").column, last = ballIn(folder / "2.png").column;
    CHECK(ballIn(folder / "1.png").column == Approx((first + last) / 2.0).margin(0.5));
    CHECK(last - first > 10.0);
}

TEST_CASE("osgraytrace --frames: each frame is the picture of its time", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const Outcome outcome = osgraytrace(
        folder, kQuickBall + "--frames 0:2 --fps 2 -o f.%03d.png -o f%d.exr --stats s%2d.json");
    CHECK(outcome.exitCode == 1); // %2d would leave blanks in names
    CHECK(folder.fileNames() == Names{"ball.osgt"});

    const std::string frames = "--frames 0:2 --fps 2 -o f.%03d.png -o f%d.exr --stats s%d.json";
    const Outcome done = osgraytrace(folder, kQuickBall + frames);
    REQUIRE(done.exitCode == 0);
    CHECK_THAT(done.output, Contains("frame 0: whitted, 2 passes") && Contains("frame 2: "));
    CHECK(folder.fileNames() == Names{"ball.osgt", "f.000.png", "f.001.png", "f.002.png", "f0.exr",
                                      "f1.exr", "f2.exr", "s0.json", "s1.json", "s2.json"});

    REQUIRE(osgraytrace(folder, kQuickBall + "--at 0.5 -o at.exr").exitCode == 0);
    CHECK((contents(folder / "f1.exr") == contents(folder / "at.exr")));
    CHECK((contents(folder / "f1.exr") != contents(folder / "f0.exr")));
    REQUIRE(osgraytrace(folder, kQuickBall + "--frames 2 --fps 2 -o alone%d.exr").exitCode == 0);
    CHECK((contents(folder / "f2.exr") == contents(folder / "alone2.exr")));
}

TEST_CASE("osgraytrace --frames: frames whose files are there are left out on request", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    std::ofstream(folder / "f0.png") << "kept";
    std::ofstream(folder / "f1.png") << "half of a frame";
    std::ofstream(folder / "s0.json") << "kept";
    const std::string frames = kQuickBall + "--frames 0:2 -o f%d.png --stats s%d.json ";
    const Outcome outcome = osgraytrace(folder, frames + "--skip-existing");
    REQUIRE(outcome.exitCode == 0);
    CHECK(contents(folder / "f0.png") == "kept");
    CHECK(contents(folder / "s0.json") == "kept");
    CHECK(contents(folder / "f1.png") != "half of a frame");
    CHECK_THAT(outcome.output,
               !Contains("frame 0") && Contains("frame 1: ") && Contains("frame 2"));
    REQUIRE(osgraytrace(folder, frames).exitCode == 0);
    CHECK(contents(folder / "f0.png") != "kept");
}

TEST_CASE("osgraytrace --frames: wrong usage is named", "[apps][long]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const std::pair<const char*, const char*> wrong[] = {
        {"--frames 0:2 -o x.png", "x.png: --frames needs one place for the number"},
        {"--frames 0:2 -o %d%d.png", "%d%d.png: --frames needs one place"},
        {"--frames 0:2 -o %s.png", "%s.png: --frames needs one place"},
        {"--frames 0:2 -o %0d.png", "%0d.png: --frames needs one place"},
        {"--frames 0:2 -o x%d.png --stats s.json", "s.json: --frames needs one place"},
        {"--frames 2:0 -o x%d.png", "2:0: is not FIRST:LAST"},
        {"--frames -1:2 -o x%d.png", "--frames"},
        {"--frames 0:99999999 -o x%d.png", "is not FIRST:LAST"},
        {"--frames 0: -o x%d.png", "0:: is not FIRST:LAST"},
        {"--frames 0:2 --report", "--frames needs an -o FILE"},
        {"--frames 0:2 --at 1 -o x%d.png", "--at"},
        {"--frames 0:2 --fps 0 -o x%d.png", "'0' is not a number above 0"},
        {"--fps 2 -o x.png", "--fps"},
        {"--skip-existing -o x.png", "--skip-existing"},
        {"--frames 0:2 --reference r.exr -o x%d.png", "--frames excludes --reference"},
        {"--at -1 -o x.png", "--at"},
    };
    for (const auto& [arguments, message] : wrong)
    {
        CAPTURE(arguments);
        const Outcome outcome = osgraytrace(folder, kQuickBall + arguments);
        CHECK(outcome.exitCode == 1);
        CHECK_THAT(outcome.errors, Contains(message));
    }
    const Outcome jpeg = osgraytrace(folder, "ball.osgt --size 70000 1 --frames 0:1 -o x%d.jpg");
    CHECK(jpeg.exitCode == 4);
    CHECK(folder.fileNames() == Names{"ball.osgt"});
}

TEST_CASE("osgraytrace --frames: a signal leaves whole frames only", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    RunningProgram program(folder / ".",
                           {OSGRAYTRACE_TEST_PROGRAM, "ball.osgt", "--size", "64", "16", "--frames",
                            "0:1000000", "--passes", "2000", "-o", "x%d.png"});
    REQUIRE(program.prints("frame 0: "));
    program.signal(SIGTERM); // long before the next frame is done
    CHECK(program.wait() == 143);
    CHECK(folder.fileNames() == Names{"ball.osgt", "x0.png"});
    CHECK_THAT(program.printed(), Contains("osgraytrace: SIGTERM"));
}
