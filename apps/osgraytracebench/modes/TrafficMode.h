// TrafficMode.h - error and cost of a still view of a town in which some cars move. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>

namespace osgRayTrace::bench
{

struct TrafficOptions
{
    int width = 320;      ///< width of the pictures [pixels]; 16:9
    int references = 512; ///< passes of the converged pictures
    int frames = 40;      ///< frames of which the last thirds are compared
    std::string pictures; ///< folder for the last frame's pictures; empty: none are written
};

/// Measures frames of one pass each, so that no clock counts: relMSE against converged pictures of
/// the same frames if each frame begins anew and if samples are kept, and the CPU time of a frame.
void measureTraffic(const TrafficOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
