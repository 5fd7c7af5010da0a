// UpsampleMode.h - what images of fewer pixels lose, and what it costs to show them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// The Cornell box, 10,000 objects and models, each at 1920 x 1080 from images of a half and a
/// quarter of the width: the error against the full size as blocks, linear between pixels and along
/// edges, and the CPU time of the parts, of one thread. pictures: a folder for them as well; empty:
/// none.
void measureUpsampling(const std::vector<std::string>& models, const std::string& pictures,
                       Rows& rows);

} // namespace osgRayTrace::bench
