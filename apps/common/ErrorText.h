// ErrorText.h - an estimated error as all programs write it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/Statistics>

#include <string>

namespace osgRayTrace::app
{

/// Returns an error as "1.8 %"; in words from 100 % on, since the number then says no more than
/// that.
std::string errorText(double relativeError);

/// Returns the estimate of a picture's error as "36 % (median tile 2.9 %, the worst 0.1 % of the
/// pixels hold 88 % of its square)". The median tile tells of most of the picture.
std::string estimateText(const Statistics& statistics);

} // namespace osgRayTrace::app
