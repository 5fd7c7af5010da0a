// CheckpointKeeper.h - a render that goes on from a file and writes it now and then. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Checkpoint.h"
#include "Options.h"

#include <osgRayTrace/Renderer>

#include <osg/Vec4>

#include <chrono>
#include <future>

namespace osgRayTrace::app
{

/// Keeps the checkpoint that the options ask for; does nothing if they ask for none.
class CheckpointKeeper
{
public:
    /// Lets the renderer begin with the passes of the file, if it is there. Throws
    /// Failure(kCannotLoad), and Failure(kUsage) if the settings make passes that depend on all
    /// before.
    CheckpointKeeper(const Options& options, const osg::Vec4& clearColor, Renderer& renderer);

    /// Writes the file if the interval is over, on a thread of its own: the render goes on. A
    /// failure is printed: there may be room later.
    void keepIfDue();

    /// Writes the file if there are whole passes. Returns the exit code: a failure is printed, as
    /// the picture is there still.
    int keep();

private:
    Checkpoint checkpoint() const;

    const Options& _options;
    osg::Vec4 _clearColor;
    Renderer& _renderer;
    std::chrono::steady_clock::time_point _kept;
    std::future<int> _writing; ///< ends before all else goes
};

} // namespace osgRayTrace::app
