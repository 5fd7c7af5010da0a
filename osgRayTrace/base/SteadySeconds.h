// SteadySeconds.h - the clock that measures how long things take. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace osgRayTrace::engine
{

/// Returns the seconds since a moment that is the same for all callers of a process. The clock
/// never goes back, whatever becomes of the system's time. Any thread may call it.
inline double steadySeconds()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

} // namespace osgRayTrace::engine
