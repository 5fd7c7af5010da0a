// UnusedContent.h - what captures cost a scene in which nothing draws in cull alone. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures updates at rest and conversions of 10,000 instances, all of OSG's classes: with a cull
/// visitor that would run nodes of the application's, against none.
void measureUnusedContent(Rows& rows);

} // namespace osgRayTrace::bench
