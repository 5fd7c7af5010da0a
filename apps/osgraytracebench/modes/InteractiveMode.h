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
    bool cpuClock = false; ///< true: time is the process's CPU time over its threads
    std::string only;      ///< part of the names of scenes that are measured; empty: all
};

/// Measures a camera that moves, stops and jumps, under budgets of 16, 33 and 100 ms. The wall
/// clock counts the time that other programs take of the machine. cpuClock measures as if there
/// were no others: exactly for one thread, and as if none of several threads ever waited for
/// another. There is no OpenGL: the display's buffers are resolved as in a viewer, and a copy of
/// them stands for their upload.
void measureInteractive(const InteractiveOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
