// Output.h - what programs write: checked before the work, whole or not at all. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Failure.h"

#include <functional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// A file that the command line asks for.
struct Output
{
    std::string option; ///< as it was given: "--stats"
    std::string path;
};

/// What to throw for a file that could not be written.
Failure cannotWrite(const std::string& path, const std::string& reason);

/// Throws Failure(kCannotWrite) if one of them cannot be written, Failure(kUsage) if two of them
/// are one file, by links as well: better now than after the work.
void checkOutputs(const std::vector<Output>& outputs);

/// Lets write fill a file, of the path that it is given, and puts it to path: see
/// engine::writeFileWhole. Whatever write throws becomes a Failure(kCannotWrite).
void writeOutput(const std::string& path,
                 const std::function<void(const std::string& temporary)>& write);

/// Throws Failure(kCannotWrite).
void writeText(const std::string& path, const std::string& text);

/// Throws Failure(kCannotWrite) if anything that was printed did not get there.
void checkStandardOutput();

} // namespace osgRayTrace::app
