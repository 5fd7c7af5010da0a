// EmbreeVersion.h - which Embree traces. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::engine
{

/// Returns the version that the engine was compiled with, as "3.13.5".
const char* embreeVersion();

} // namespace osgRayTrace::engine
