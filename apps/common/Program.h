// Program.h - how programs begin and end: signals, errors, exit codes. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Failure.h"

#include <functional>
#include <string>

namespace osgRayTrace::app
{

/// Prints the failure as one line on standard error; returns its exit code.
int reportFailure(const std::string& name, const Failure& failure);

/// Returns what --version prints: "osgraytrace 0.1.0".
std::string versionText(const std::string& name);

/// Runs a program and returns its exit code. Failures and other exceptions become a line on
/// standard error; text that could not be printed to standard output ends with kCannotWrite. After
/// a signal that an OrderlyEnd has recorded the exit code is the signal's, unless something failed.
int runProgram(const std::string& name, const std::function<int()>& run);

} // namespace osgRayTrace::app
