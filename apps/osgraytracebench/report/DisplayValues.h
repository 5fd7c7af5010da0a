// DisplayValues.h - pictures as a reader of the report sees them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Reference.h"

#include <vector>

namespace osgRayTrace::bench
{

/// Returns display values of a picture at the exposure that brings the reference's mean luminance
/// to 0.4.
std::vector<float> displayValues(const Pixels& pixels, const Reference& reference);
std::vector<float> displayValues(const Reference& reference);

} // namespace osgRayTrace::bench
