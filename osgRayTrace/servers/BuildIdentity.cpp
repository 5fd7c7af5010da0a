// BuildIdentity.cpp - whose pictures are those of this process, bit by bit. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/BuildIdentity.h"

#include "osgRayTrace/accel/EmbreeVersion.h"
#include "osgRayTrace/base/Cpu.h"

namespace osgRayTrace::engine
{

namespace
{

// Compilers round alike only if they choose the same instructions.
#if defined(__clang__)
constexpr const char* kCompiler = "Clang " __clang_version__;
#elif defined(__GNUC__)
constexpr const char* kCompiler = "GCC " __VERSION__;
#else
constexpr const char* kCompiler = "another compiler";
#endif

/// Counts the forms that messages have had, of scenes and of counts, too.
constexpr int kMessages = 11;

} // namespace

std::string buildIdentity()
{
    return std::string("osgRayTrace " OSGRAYTRACE_PROJECT_VERSION " (messages ") +
           std::to_string(kMessages) + "), Embree " + embreeVersion() + ", " + cpuLevel() + ", " +
           kCompiler + ", " OSGRAYTRACE_BUILD_TYPE;
}

} // namespace osgRayTrace::engine
