// NoBlosc.cpp - stands for Blosc.cpp where the library is not there. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/Blosc.h"

#include "osgPlugins/vdb/VdbBytes.h"

namespace osgRayTrace::vdb
{

void decompressBlosc(const unsigned char*, std::size_t, unsigned char*, std::size_t)
{
    throw VdbError("it is compressed by blosc, and this plugin was built without that library");
}

} // namespace osgRayTrace::vdb
