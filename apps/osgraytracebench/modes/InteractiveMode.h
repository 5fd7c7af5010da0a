// InteractiveMode.h - whether frames keep to their budgets. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>

namespace osgRayTrace::bench
{

struct InteractiveOptions
{
    int width = 1920;
    int height = 1080;
    int threads = 0;       ///< 0: all of the machine
    bool cpuClock = false; ///< time is what the process took of its cores, over its threads
    std::string only;      ///< scenes whose name holds this
};

/// A camera that moves, stops and jumps, under budgets of 16, 33 and 100 ms. By the clock on the
/// wall: what other programs take of the machine is in it; or by cpuClock, as if there were none:
/// exact for one thread, and as if none of several ever waited for another. Without OpenGL: the
/// display's buffers are resolved as in a viewer, and a copy of them stands for their upload.
void measureInteractive(const InteractiveOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
