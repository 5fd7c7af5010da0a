// MotionOptions.h - the options of times, frames and cameras that move. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"

#include <CLI/CLI.hpp>

#include <string>

namespace osgRayTrace::app
{

/// Holds texts of the command line before they are checked.
struct RawMotion
{
    std::string frames;
    std::string cameraPath;
};

/// Adds the options to the command line.
void addMotionOptions(CLI::App& app, Options& options, RawMotion& raw);

/// Takes the values over, and the frames of a moving view if none are given. Throws Failure.
void applyMotion(const CLI::App& app, const RawMotion& raw, Options& options);

} // namespace osgRayTrace::app
