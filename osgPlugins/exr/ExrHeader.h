// ExrHeader.h - what an OpenEXR file claims, before memory is taken for it. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>

namespace osgRayTrace::engine
{

constexpr int kExrMaxSide = 1 << 20;
constexpr long long kExrMaxPixels = 1LL << 28;

/// True if a picture of this size is not empty and within the limits.
bool isExrSize(long long width, long long height);

/// Empty if the headers of all parts are within the limits and no longer than the file, else one
/// sentence. OpenEXR would allocate first and read then; its own limits are global and belong to
/// the host program. Leaves the stream where it was.
std::string checkExrHeader(std::istream& stream);

} // namespace osgRayTrace::engine
