// TransportMode.h - error times time of scenes that are hard for light transport. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>

namespace osgRayTrace::bench
{

struct TransportOptions
{
    int width = 64;                 ///< width of the pictures [pixels]
    double seconds = 2.0;           ///< budget of a picture [s]
    int seeds = 4;                  ///< pictures of each method
    double referenceSeconds = 30.0; ///< seconds for a reference that is rendered
    std::string only;               ///< part of the names of the scenes that are measured
};

/// Measures relMSE x seconds of the methods of transportScenes, scaled to 512 x 512 pixels and two
/// threads, and the ratio of each method's mean to that of the reference. Throws app::Failure.
void measureTransport(const TransportOptions& options, Rows& rows);

} // namespace osgRayTrace::bench
