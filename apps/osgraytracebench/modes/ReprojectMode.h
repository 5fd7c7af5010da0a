// ReprojectMode.h - gain and cost of the samples of earlier frames. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>

namespace osgRayTrace::bench
{

struct ReprojectOptions
{
    int width = 320;      ///< width of the pictures whose error is measured [pixels]; 16:9
    int references = 256; ///< passes of the converged pictures
    std::string pictures; ///< folder for the last frame's pictures; empty: none are written
    bool costs = true;    ///< true: measure 1920 x 1080, too
};

/// Measures along a path of a head at one pass a frame, by scene: relMSE with and without
/// reprojection, against a converged picture at the same frame; the ratio at equal CPU time, as the
/// error of independent passes falls with their number; and the cost of a frame.
void measureReprojection(const ReprojectOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
