// AssertTest.cpp - an assertion that is on ends the program and says where.
// SPDX-License-Identifier: MIT
#if !defined(OSGRAYTRACE_ASSERTS)
#define OSGRAYTRACE_ASSERTS
#endif
#include "osgRayTrace/base/Assert.h"

#include "tests/Catch.h"

#include <csignal>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace
{

struct Ending
{
    int status = 0;
    std::string message;
};

void assertBelowTen(int number)
{
    OSGRAYTRACE_ASSERT(number < 10);
}
constexpr int kAssertionLine = __LINE__ - 2;

/// Returns how a child process ends that asserts that a number is below ten.
Ending endOfAssertion(int number)
{
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
        std::signal(SIGABRT, SIG_DFL); // Catch2's handler would report a failed case
        dup2(ends[1], STDERR_FILENO);
        close(ends[0]);
        close(ends[1]);
        assertBelowTen(number);
        _exit(0);
    }
    close(ends[1]);
    Ending ending;
    char text[256];
    for (ssize_t count; (count = read(ends[0], text, sizeof(text))) > 0;)
        ending.message.append(text, static_cast<std::size_t>(count));
    close(ends[0]);
    REQUIRE(waitpid(child, &ending.status, 0) == child);
    return ending;
}

} // namespace

TEST_CASE("an assertion that holds lets the program go on", "[base]")
{
    const Ending ending = endOfAssertion(9);
    CHECK(WIFEXITED(ending.status));
    CHECK(WEXITSTATUS(ending.status) == 0);
    CHECK(ending.message.empty());
}

TEST_CASE("an assertion that does not hold aborts and says what, in which file and line", "[base]")
{
    const Ending ending = endOfAssertion(10);
    REQUIRE(WIFSIGNALED(ending.status));
    CHECK(WTERMSIG(ending.status) == SIGABRT);
    CHECK(ending.message.find("assertion failed: number < 10") != std::string::npos);
    CHECK(ending.message.find("AssertTest.cpp:" + std::to_string(kAssertionLine)) !=
          std::string::npos);
}
