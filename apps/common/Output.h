// Output.h - outputs of programs: checked before the work, whole or not at all. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Failure.h"

#include <functional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Describes a file that the command line asks for.
struct Output
{
    std::string option; ///< as on the command line: "--stats"
    std::string path;
};

/// Returns the failure for a file that could not be written.
Failure cannotWrite(const std::string& path, const std::string& reason);

/// Throws Failure(kCannotWrite) if one of the files cannot be written, and Failure(kUsage) if two
/// of them are one file, by links as well: the check comes before the work.
void checkOutputs(const std::vector<Output>& outputs);

/// Lets write fill a file, of the path that it is given, and moves that file to path: see
/// engine::writeFileWhole. Any exception of write becomes a Failure(kCannotWrite).
void writeOutput(const std::string& path,
                 const std::function<void(const std::string& temporary)>& write);

/// Writes a text. Throws Failure(kCannotWrite).
void writeText(const std::string& path, const std::string& text);

/// Throws Failure(kCannotWrite) if a part of the printed text did not get to standard output.
void checkStandardOutput();

} // namespace osgRayTrace::app
