// BuildIdentity.cpp - whose pictures are those of this process, bit by bit. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/BuildIdentity.h"

#include "osgRayTrace/accel/EmbreeVersion.h"
#include "osgRayTrace/base/Cpu.h"

namespace osgRayTrace::engine
{

namespace
{

/// Counts the forms that messages have had.
constexpr int kMessages = 1;

} // namespace

std::string buildIdentity()
{
    return std::string("osgRayTrace " OSGRAYTRACE_PROJECT_VERSION " (messages ") +
           std::to_string(kMessages) + "), Embree " + embreeVersion() + ", " + cpuLevel();
}

} // namespace osgRayTrace::engine
