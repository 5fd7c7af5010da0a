// Program.cpp - runs a program between setup and its exit code. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Program.h"

#include "apps/common/ErrorLine.h"
#include "apps/common/Interruption.h"
#include "apps/common/Output.h"

#include <osgRayTrace/Version>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <exception>

namespace osgRayTrace::app
{

namespace
{

/// Opens standard streams that are closed: otherwise the next file that is opened would take their
/// place, and get what is printed. They are opened the wrong way round, so that they fail as closed
/// ones do.
void holdStandardStreams()
{
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    {
        const bool closed = fcntl(number, F_GETFD) < 0 && errno == EBADF;
        if (closed && open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
    }
}

int codeOf(const std::string& name, const std::function<int()>& run)
{
    try
    {
        return run();
    }
    catch (const Failure& failure)
    {
        return reportFailure(name, failure);
    }
    catch (const std::exception& error)
    {
        printError(name, error.what());
        return kCannotRender;
    }
}

} // namespace

int reportFailure(const std::string& name, const Failure& failure)
{
    printError(name, failure.what());
    return failure.code();
}

std::string versionText(const std::string& name)
{
    return name + " " + osgRayTraceGetVersion();
}

int runProgram(const std::string& name, const std::function<int()>& run)
{
    holdStandardStreams();
    handleSignals();
    const int code = codeOf(name, run);
    const int printed = codeOf(name,
                               []
                               {
                                   checkStandardOutput();
                                   return int(kDone);
                               });
    if (code != kDone) return code;
    return printed != kDone ? printed : interruptionCode();
}

} // namespace osgRayTrace::app
