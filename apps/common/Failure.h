// Failure.h - an exception with the exit code of the program. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace osgRayTrace::app
{

enum ExitCode
{
    kDone = 0,
    kUsage = 1,
    kCannotLoad = 2,
    kCannotRender = 3,
    kCannotWrite = 4,
};

/// Ends a program: runProgram catches it and prints the message as one line.
class Failure : public std::runtime_error
{
public:
    /// Makes a failure. code: an ExitCode, or the exit code of a signal.
    Failure(int code, const std::string& message) : std::runtime_error(message), _code(code) {}
    int code() const { return _code; }

private:
    int _code;
};

} // namespace osgRayTrace::app
