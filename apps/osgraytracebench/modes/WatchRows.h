// WatchRows.h - what memory that is fetched ahead brings to a look at a graph. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// Measures looks of two GraphWatches at the same unchanged graph of 40,000 drawables below
/// transforms of their own, which lie in memory in no order: one fetches ahead, the other does not.
/// The goal is the least gain for which Prefetch.h is kept.
void measureWatch(Rows& rows);

} // namespace osgRayTrace::bench
