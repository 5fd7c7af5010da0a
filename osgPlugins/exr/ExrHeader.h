// ExrHeader.h - checks what an OpenEXR file claims before memory is taken. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>

namespace osgRayTrace::engine
{

constexpr int kExrMaxSide = 1 << 20;
constexpr long long kExrMaxPixels = 1LL << 28;

/// Returns true if a picture of this size is not empty and within the limits.
bool isExrSize(long long width, long long height);

/// Returns an empty string if the headers of all parts are within the limits and promise no more
/// than the file's length can hold, else one sentence. OpenEXR would allocate first and read then;
/// its own limits are global and belong to the host program. The stream is left where it was.
std::string checkExrHeader(std::istream& stream);

} // namespace osgRayTrace::engine
