// BackgroundThreads.h - threads of our own, none of which outlives the process's orderly end.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace osgRayTrace::engine
{

/// Runs body on a new thread. stop: makes body return soon; called, by any thread, when the process
/// ends by exit() or from main: then all such threads are stopped and joined before libraries and
/// static objects go. body is destroyed on its thread. False, and nothing done, if that has
/// happened already. Throws std::system_error if there can be no thread. Any thread.
bool startBackgroundThread(std::function<void()> body, std::function<void()> stop);

} // namespace osgRayTrace::engine
