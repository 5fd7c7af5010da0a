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

/// Caught in main, which prints the message as one line.
class Failure : public std::runtime_error
{
public:
    Failure(ExitCode code, const std::string& message) : std::runtime_error(message), _code(code) {}
    ExitCode code() const { return _code; }

private:
    ExitCode _code;
};

} // namespace osgRayTrace::app
