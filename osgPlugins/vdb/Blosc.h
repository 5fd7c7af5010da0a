// Blosc.h - decompresses values by the library blosc, which is optional. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osgRayTrace::vdb
{

/// Decompresses bytes to exactly so many others, which have room at `to`. Throws a VdbError if the
/// bytes are wrong, or if the plugin was built without the library.
void decompressBlosc(const unsigned char* from, std::size_t length, unsigned char* to,
                     std::size_t madeLength);

} // namespace osgRayTrace::vdb
