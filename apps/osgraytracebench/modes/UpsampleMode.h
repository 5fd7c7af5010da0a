// UpsampleMode.h - the loss in images of fewer pixels, and the cost of upsampling. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Measures the Cornell box, 10,000 objects and models, each at 1920 x 1080 from images of a half
/// and a quarter of the width: the error against the full size as blocks, linear between pixels and
/// along edges, and the CPU time of the parts, of one thread. pictures: a folder to which the
/// pictures are written; empty: none.
void measureUpsampling(const std::vector<std::string>& models, const std::string& pictures,
                       Rows& rows);

} // namespace osgRayTrace::bench
