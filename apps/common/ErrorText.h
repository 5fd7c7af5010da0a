// ErrorText.h - an estimated error as all programs write it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::app
{

/// Returns an error as "1.8 %"; in words from 100 % on, since the number then says no more than
/// that.
std::string errorText(double relativeError);

} // namespace osgRayTrace::app
