// EmbreeVersion.cpp - the version of Embree's headers. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/EmbreeVersion.h"

#include "osgRayTrace/accel/Embree.h"

namespace osgRayTrace::engine
{

const char* embreeVersion()
{
    return RTC_VERSION_STRING;
}

} // namespace osgRayTrace::engine
