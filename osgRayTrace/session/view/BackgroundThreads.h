// BackgroundThreads.h - threads that end before the process does in order. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace osgRayTrace::engine
{

/// Runs body on a new thread, and returns true. stop makes body return soon; any thread calls stop
/// when the process ends by exit() or from main: then all such threads are stopped and joined
/// before libraries and static objects go. body is destroyed on its thread. Returns false, and does
/// nothing, if the process ends already. Throws std::system_error if no thread can be started. Any
/// thread may call it.
bool startBackgroundThread(std::function<void()> body, std::function<void()> stop);

} // namespace osgRayTrace::engine
