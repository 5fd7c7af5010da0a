// Assert.h - checks of conditions that only a mistake in this library can break. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <cstdlib>

/// Ends the program with a message if the condition does not hold. Assertions are on in builds that
/// define OSGRAYTRACE_ASSERTS (build type Debug, sanitizers, the CMake option of that name). In
/// other builds an assertion is compiled but never evaluated, so its condition must have no effect.
#if defined(OSGRAYTRACE_ASSERTS)
#define OSGRAYTRACE_ASSERT(condition)                                                              \
    ((condition) ? static_cast<void>(0)                                                            \
                 : ::osgRayTrace::engine::assertionFailed(#condition, __FILE__, __LINE__))
#else
#define OSGRAYTRACE_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#endif

namespace osgRayTrace::engine
{

[[noreturn]] inline void assertionFailed(const char* condition, const char* file, int line)
{
    std::fprintf(stderr, "osgRayTrace: assertion failed: %s (%s:%d)\n", condition, file, line);
    std::abort();
}

} // namespace osgRayTrace::engine
