// BackgroundThreads.h - threads of the library, none of which outlives the process's orderly end.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace osgRayTrace::engine
{

/// Runs body on a new thread. stop makes body return soon; any thread calls stop when the process
/// ends by exit() or from main: then all such threads are stopped and joined before libraries and
/// static objects go. body is destroyed on its thread. The result is false, and nothing is done, if
/// the process ends already. Throws std::system_error if there can be no thread. Any thread.
bool startBackgroundThread(std::function<void()> body, std::function<void()> stop);

} // namespace osgRayTrace::engine
