// ChildProcess.h - how a process ends that does what ends processes. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <csignal>
#include <functional>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

namespace osgRayTrace::test
{

/// Returns whether a child process that runs body is ended by an assertion. Throws if it ends in
/// any other way but by itself.
inline bool isAborted(const std::function<void()>& body)
{
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork failed");
    if (child == 0)
    {
        std::signal(SIGABRT, SIG_DFL); // Catch2's handler would report a failed case
        close(STDERR_FILENO);
        body();
        _exit(0);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child) throw std::runtime_error("waitpid failed");
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT) return true;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return false;
    throw std::runtime_error("the child process was ended otherwise");
}

} // namespace osgRayTrace::test
