// TransportMode.h - error times time of scenes that are hard for light transport. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <cstdint>
#include <string>

namespace osgRayTrace::bench
{

struct TransportOptions
{
    int width = 64;                 ///< width of the pictures [pixels]
    double seconds = 1.0;           ///< budget of a picture [s of one thread]
    int seeds = 5;                  ///< pictures of each method
    uint32_t firstSeed = 1;         ///< seed of the first picture
    double referenceSeconds = 30.0; ///< budget of a reference that is rendered [s of one thread]
    std::string only;               ///< part of the names of the scenes that are measured
};

/// Measures relMSE x seconds of the methods of transportScenes, scaled to 512 x 512 pixels and two
/// threads, and the ratio of each method's mean to that of the reference. A budget becomes a number
/// of passes, a power of two, and time is that of one thread's processor: neither hangs on what
/// else the machine does. Throws app::Failure.
void measureTransport(const TransportOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
