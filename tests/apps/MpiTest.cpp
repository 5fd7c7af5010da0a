// MpiTest.cpp - osgraytrace --mpi with real processes: the files are those of one process.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

#include <chrono>
#include <thread>

using Catch::Matchers::Contains;

namespace
{

using Clock = std::chrono::steady_clock;

const std::string kView = " --light-samples 1 --fovy 20 --size 40 24 --photons 2000 ";

/// Returns the shell's words of a launch that needs neither cores nor a user of its own.
std::string launch(int ranks)
{
    return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 60 "
           "mpirun --oversubscribe --bind-to none -n " +
           std::to_string(ranks) + " ";
}

/// Runs so many processes of osgraytrace in the folder; others: more of the command, as ": -n 1
/// PROGRAM ARGUMENTS".
Outcome mpirun(const TemporaryFolder& folder, int ranks, const std::string& arguments)
{
    return osgraytrace(folder, arguments, launch(ranks));
}

std::string renderOf(const std::string& scene, const std::string& more)
{
    return dataFile(scene) + kView + more;
}

/// Returns the processes of this test's own that run with this argument.
std::vector<pid_t> processesWith(const std::string& argument)
{
    std::vector<pid_t> processes;
    for (const auto& entry : std::filesystem::directory_iterator("/proc"))
    {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::string line = contents(entry.path() / "cmdline");
        const bool is = line.find(OSGRAYTRACE_TEST_PROGRAM) == 0;
        if (is && line.find(argument) != std::string::npos) processes.push_back(std::stoi(name));
    }
    return processes;
}

/// Returns mpirun with three ranks as a running program.
std::vector<std::string> wordsOf(const std::string& arguments)
{
    return {"/bin/sh", "-c",
            "exec " + std::string("env ") + launch(3) + OSGRAYTRACE_TEST_PROGRAM + " " +
                renderOf("cornell_box.osgt", arguments)};
}

/// Waits until a file is there; at most a minute.
bool appears(const std::string& file)
{
    const auto end = Clock::now() + std::chrono::minutes(1);
    while (!std::filesystem::exists(file) && Clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return std::filesystem::exists(file);
}

} // namespace

TEST_CASE("mpi: any ranks and threads give the files of one process", "[apps]")
{
    // Photons depend on the first 16 passes; the other integrators on nothing.
    int turn = 0;
    const std::pair<std::string, std::vector<int>> cases[] = {
        {"path", {2, 7}}, {"sppm", {1, 2, 3, 7}}, {"photon-caustics", {3}}};
    for (const auto& [integrator, sizes] : cases)
    {
        const TemporaryFolder folder;
        const std::string options =
            "--integrator " + integrator + " --passes 24 --interval 0.02 --checkpoint ";
        REQUIRE(osgraytrace(folder, renderOf("cornell_box_glass.osgt",
                                             options + "one.exr -o one_picture.exr -o one.png "
                                                       "--aov depth,normal"))
                    .exitCode == 0);
        for (const int ranks : sizes)
        {
            CAPTURE(integrator, ranks);
            std::filesystem::remove(folder / "all.exr");
            const Outcome outcome =
                mpirun(folder, ranks,
                       renderOf("cornell_box_glass.osgt",
                                options +
                                    "all.exr -o all_picture.exr -o all.png --aov depth,normal "
                                    "--mpi --threads " +
                                    std::to_string(1 + turn++ % 3)));
            CAPTURE(outcome.errors);
            REQUIRE(outcome.exitCode == 0);
            CHECK((contents(folder / "all.exr") == contents(folder / "one.exr")));
            CHECK((contents(folder / "all_picture.exr") == contents(folder / "one_picture.exr")));
            CHECK((contents(folder / "all.png") == contents(folder / "one.png")));
            CHECK_THAT(outcome.output, Contains("24 passes"));
        }
    }
}

TEST_CASE("mpi: a killed rank ends the job, and the same command goes on", "[apps]")
{
    const TemporaryFolder folder;
    const std::string file = folder / "x.exr";
    RunningProgram program(folder / ".",
                           wordsOf("--mpi --passes 400000 --interval 0.05 --checkpoint " + file));
    REQUIRE(appears(file));
    const std::vector<pid_t> ranks = processesWith(file);
    REQUIRE(ranks.size() == 3);
    kill(ranks[1], SIGKILL);
    CHECK(program.wait() != 0);

    // The passes of the file are part of a picture of any length.
    const Outcome info = osgraytrace(folder, "--merge x.exr -o x.png");
    const int done = std::stoi(info.output);
    REQUIRE(done > 0);
    const std::string passes = "--passes " + std::to_string(done + 50) + " --checkpoint ";
    const Outcome again = mpirun(folder, 2, renderOf("cornell_box.osgt", passes + "x.exr --mpi"));
    CAPTURE(again.errors);
    CHECK(again.exitCode == 0);
    CHECK_THAT(again.errors, Contains("x.exr: goes on from passes 0-"));
    REQUIRE(osgraytrace(folder, renderOf("cornell_box.osgt", passes + "one.exr")).exitCode == 0);
    CHECK((contents(folder / "x.exr") == contents(folder / "one.exr")));
}

TEST_CASE("mpi: a signal ends with the passes at work, and says how to go on", "[apps]")
{
    const TemporaryFolder folder;
    const std::string file = folder / "x.exr";
    RunningProgram program(
        folder / ".",
        wordsOf("--mpi --passes 400000 --interval 0.05 -o x.png --checkpoint " + file));
    REQUIRE(appears(file));
    for (const pid_t rank : processesWith(file))
        kill(rank, SIGUSR1);
    CHECK(program.wait() == 128 + SIGUSR1);
    CHECK_THAT(program.printed(), Contains("osgraytrace: SIGUSR1: ") &&
                                      Contains("the same command goes on from " + file));
    const Outcome merged = osgraytrace(folder, "--merge x.exr -o y.png");
    CHECK(merged.exitCode == 0);
    CHECK((contents(folder / "x.png") == contents(folder / "y.png")));
}

TEST_CASE("mpi: what cannot be is said in one sentence", "[apps]")
{
    const TemporaryFolder folder;
    const std::string box = renderOf("cornell_box.osgt", "--passes 3 -o x.png ");
    const std::string other = " : -n 1 '" OSGRAYTRACE_TEST_PROGRAM "' ";
    struct Case
    {
        int ranks, code;
        std::string arguments, reason;
    };
    const Case cases[] = {
        {3, 1, box, "3 processes were started, and each would make the whole picture: --mpi"},
        {1, 3, box + "--mpi" + other + box + "--mpi --seed 1",
         "would render another picture: seed 1 there, seed 0 on"},
        {1, 2, box + "--mpi" + other + "none.osgt -o x.png --mpi", "rank 1 on "},
        {2, 2, "none.osgt -o x.png --mpi", "cannot load none.osgt"},
        {2, 4, box + "--mpi -o none/x.png", "there is no folder none"},
        {2, 1, box + "--mpi --radius-schedule local", "each pass depends on all before"},
        {2, 1, box + "--mpi --context osmesa", "--mpi excludes --context"},
        {2, 2, "none.osgt -o x.png --mpi --send-scene", "cannot load none.osgt"},
        {1, 1, box + "--mpi --send-scene --shutter 1", "--send-scene excludes --shutter"},
        {1, 1, box + "--send-scene", "--send-scene requires --mpi"},
    };
    for (const Case& each : cases)
    {
        CAPTURE(each.arguments);
        const Outcome outcome = mpirun(folder, each.ranks, each.arguments);
        CHECK(outcome.exitCode == each.code);
        CHECK_THAT(outcome.errors, Contains(each.reason));
        CHECK(folder.fileNames().empty());
    }
}

TEST_CASE("mpi: an error target ends with the same pass on any ranks", "[apps]")
{
    const TemporaryFolder folder;
    for (const int ranks : {1, 3})
        REQUIRE(mpirun(folder, ranks,
                       renderOf("cornell_box.osgt",
                                "--mpi --error 0.03 -o x" + std::to_string(ranks) + ".exr"))
                    .exitCode == 0);
    CHECK((contents(folder / "x1.exr") == contents(folder / "x3.exr")));
}

TEST_CASE("mpi: ranks that have neither model nor plugins get the scene of rank 0", "[apps]")
{
    // Others are in a folder without files, and look for plugins where there are none.
    const TemporaryFolder folder, elsewhere;
    std::filesystem::copy_file(OSGRAYTRACE_TEST_SOURCE "/data/cornell_box_glass.osgt",
                               folder / "box.osgt");
    const std::string others = ": -wdir '" + std::string(elsewhere / ".") +
                               "' -n 2 env OSG_LIBRARY_PATH=/none OSG_FILE_PATH=/none "
                               "'" OSGRAYTRACE_TEST_PROGRAM "' ";
    for (const std::string integrator : {"path", "sppm"})
    {
        CAPTURE(integrator);
        const std::string command =
            "box.osgt" + kView + "--passes 24 --integrator " + integrator + " --checkpoint ";
        std::filesystem::remove(folder / "one.exr");
        std::filesystem::remove(folder / "all.exr");
        REQUIRE(osgraytrace(folder, command + "one.exr").exitCode == 0);
        const std::string own = command + "all.exr --mpi ";
        CHECK(mpirun(folder, 1, own + others + own).exitCode != 0); // they cannot read the model
        const Outcome outcome =
            mpirun(folder, 1,
                   own + "--send-scene " + others +
                       "box.osgt --passes 24 --mpi --send-scene --checkpoint all.exr --seed 3 "
                       "--size 9 9");
        CAPTURE(outcome.errors);
        REQUIRE(outcome.exitCode == 0);
        CHECK((contents(folder / "all.exr") == contents(folder / "one.exr")));
    }
    CHECK(elsewhere.fileNames().empty());
}
