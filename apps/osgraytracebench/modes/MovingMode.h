// MovingMode.h - how legible views are that move under a frame budget. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

struct MovingOptions
{
    int width = 1280;
    int height = 720;
    int threads = 2;
    double budget = 33.0;  ///< budget of a frame [ms]
    bool cpuClock = false; ///< true: time is the process's CPU time over its threads
    int frames = 60;       ///< frames before the one that is compared
    int references = 64;   ///< passes of the converged pictures
    engine::IntegratorKind integrator = engine::IntegratorKind::Automatic;
    std::string pictures;            ///< folder for the pictures; empty: none are written
    std::string only;                ///< part of the names of scenes that are measured; empty: all
    std::vector<std::string> models; ///< files, seen from an orbit
};

/// Measures a textured terrain and models under a moving camera, and a town whose traffic moves,
/// each frame as a viewer without OpenGL has it: the divider, the time of tracing and of
/// presenting, and the structural similarity (Ssim.h) of the last frame to a converged picture of
/// the same view. The same for images of fixed dividers: shown linear and along edges, with the CPU
/// seconds of both, over the threads.
void measureMoving(const MovingOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
