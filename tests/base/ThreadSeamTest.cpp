// ThreadSeamTest.cpp - a second thread in what is not thread safe ends the program.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/ThreadSeam.h"

#include "tests/Catch.h"

#include <csignal>

#include <sys/wait.h>
#include <unistd.h>

using Seam = osgRayTrace::engine::BasicThreadSeam<true>;

namespace
{

/// Returns the status with which a child process ends that enters a seam twice: at once by two
/// threads, or one after the other.
int statusOfTwoThreads(bool atOnce)
{
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
        std::signal(SIGABRT, SIG_DFL); // Catch2's handler would report a failed case
        close(STDERR_FILENO);
        Seam seam;
        const auto enter = [&] { const Seam::Entry entry(seam); };
        {
            const Seam::Entry first(seam);
            if (atOnce) std::thread(enter).join();
        }
        std::thread(enter).join();
        _exit(0);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return status;
}

} // namespace

TEST_CASE("a seam lets threads in one after the other", "[base]")
{
    const int status = statusOfTwoThreads(false);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("a seam aborts when a second thread enters", "[base]")
{
    const int status = statusOfTwoThreads(true);
    REQUIRE(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGABRT);
}

TEST_CASE("a thread may enter its seam again", "[base]")
{
    Seam seam;
    const Seam::Entry outer(seam);
    {
        const Seam::Entry inner(seam);
    }
    const Seam::Entry again(seam);
    SUCCEED();
}
