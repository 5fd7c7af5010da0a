// Blosc.cpp - checks lengths before the library trusts them. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/Blosc.h"

#include "osgPlugins/vdb/VdbBytes.h"

#include <blosc.h>

namespace osgRayTrace::vdb
{

void decompressBlosc(const unsigned char* from, std::size_t length, unsigned char* to,
                     std::size_t madeLength)
{
    // The header's own lengths must be those that are known: the library reads and writes by them.
    std::size_t made = 0;
    if (blosc_cbuffer_validate(from, length, &made) != 0 || made != madeLength ||
        blosc_decompress_ctx(from, to, madeLength, 1) != static_cast<int>(madeLength))
        throw VdbError("the values of a node cannot be decompressed");
}

} // namespace osgRayTrace::vdb
