// Failure.h - why a program ends early, and with which exit code. Layer: apps.
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

/// Caught by runProgram, which prints the message as one line.
class Failure : public std::runtime_error
{
public:
    /// code: an ExitCode, or what a signal ends with.
    Failure(int code, const std::string& message) : std::runtime_error(message), _code(code) {}
    int code() const { return _code; }

private:
    int _code;
};

} // namespace osgRayTrace::app
