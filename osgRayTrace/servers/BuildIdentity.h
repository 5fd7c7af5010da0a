// BuildIdentity.h - whose pictures are those of this process, bit by bit. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::engine
{

/// Returns version, form of messages, version of Embree, level of the processor, compiler and type
/// of build, as "osgRayTrace 1.2.3 (messages 1), Embree 3.13.5, x86-64-v3, GCC 12.2.0, Release".
/// Processes with equal texts understand each other and trace the same bits.
std::string buildIdentity();

} // namespace osgRayTrace::engine
