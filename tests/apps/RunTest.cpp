// RunTest.cpp - osgraytrace-run puts ray tracing above the scenes of another program. Layer: tests.
// SPDX-License-Identifier: MIT
#include "Program.h" // runs osgraytrace-run here
#include "tests/Catch.h"

namespace
{

Outcome run(const std::string& arguments, const std::string& prefix = "")
{
    return osgraytrace(TemporaryFolder(), arguments, prefix);
}

const std::string kForeign = "'" OSGRAYTRACE_TEST_FOREIGN "'";

} // namespace

TEST_CASE("osgraytrace-run: the scenes of another program are ray traced", "[apps]")
{
    const Outcome outcome = run(kForeign);
    CHECK(outcome.exitCode == 7); // the program's own exit code
    CHECK(outcome.output == "viewer RayTracedScene\n0 more handlers\ncleared nothing\n"
                            "new RayTracedScene\n"
                            "view RayTracedScene\nview RayTracedScene\nshared 1\n");
    CHECK(outcome.errors.empty());
}

TEST_CASE("osgraytrace-run: the program by itself knows nothing of it", "[apps]")
{
    const Outcome outcome = run("env -u LD_PRELOAD " + kForeign);
    CHECK(outcome.output.find("RayTracedScene") == std::string::npos);
    CHECK(outcome.output.find("viewer Group") == 0);
}

TEST_CASE("osgraytrace-run: lights come from variables, and wrong ones are named", "[apps]")
{
    const Outcome lit = run(kForeign, "OSGRAYTRACE_SUN=90:30 OSGRAYTRACE_HEADLIGHT=off");
    CHECK(lit.exitCode == 7);
    CHECK(lit.errors.empty());
    CHECK(run(kForeign, "OSGRAYTRACE_SUN=high").errors.find("OSGRAYTRACE_SUN cannot be 'high'") !=
          std::string::npos);
    CHECK(run(kForeign, "OSGRAYTRACE_ENVIRONMENT=none.exr").errors.find("cannot load none.exr") !=
          std::string::npos);
}

TEST_CASE("osgraytrace-run: keys are names or characters", "[apps]")
{
    CHECK(run(kForeign, "OSGRAYTRACE_TOGGLE_KEY=F3").errors.empty());
    CHECK(run(kForeign, "OSGRAYTRACE_TOGGLE_KEY=t").errors.empty());
    const Outcome wrong = run(kForeign, "OSGRAYTRACE_TOGGLE_KEY=escape");
    CHECK(wrong.exitCode == 7);
    CHECK(wrong.errors.find("'escape'") != std::string::npos);
}

TEST_CASE("osgraytrace-run: a report of the scenes is written when the program ends", "[apps]")
{
    const TemporaryFolder folder;
    std::ofstream(folder / "report.txt") << "of an earlier run";
    CHECK(osgraytrace(folder, "--report report.txt " + kForeign).exitCode == 7);
    CHECK(std::filesystem::exists(folder / "report.txt"));
    CHECK(contents(folder / "report.txt").find("earlier") == std::string::npos);
    CHECK(osgraytrace(folder, "--report report.txt true").exitCode == 0); // a program without OSG
    CHECK_FALSE(std::filesystem::exists(folder / "report.txt"));
    const Outcome nowhere = run("--report /no-such-folder/report.txt " + kForeign);
    CHECK(nowhere.exitCode == 7);
    CHECK(nowhere.errors.find("/no-such-folder/report.txt") != std::string::npos);
}

TEST_CASE("osgraytrace-run: wrong usage", "[apps]")
{
    CHECK(run("").exitCode == 1);
    CHECK(run("--help").exitCode == 0);
    CHECK(run("--help >/dev/full )", "(").exitCode == 4);
    CHECK(run("--help").output.find("OSGRAYTRACE_TOGGLE_KEY") != std::string::npos);
    for (const char* wrong : {"--passes 0 ", "--passes many ", "--max-passes 16777217 "})
        CHECK(run(wrong + kForeign).exitCode == 1);
    CHECK(run("--passes 5").exitCode == 1);
    CHECK(run("--report report.txt").exitCode == 1);
    CHECK(run("--passes 5 sh -c 'echo $OSGRAYTRACE_MAX_PASSES'").output == "5\n");
    const Outcome missing = run("no-such-program");
    CHECK(missing.exitCode == 127);
    CHECK(missing.errors.find("no-such-program") != std::string::npos);
}
