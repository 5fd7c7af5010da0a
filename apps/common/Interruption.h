// Interruption.h - Ctrl-C, SIGTERM and SIGHUP as an orderly end. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace osgRayTrace::app
{

/// Takes over SIGINT, SIGTERM and SIGHUP, unless they are ignored: outside of any OrderlyEnd they
/// end the process at once, with the code of interruptionCode(). These, and the signals of crashes,
/// remove temporary files first. Writing to a closed pipe or beyond a size limit becomes an error
/// of that write.
void handleSignals();

/// Whether one of the three signals has come. Any thread.
bool isInterrupted();

/// 128 and the signal's number, as shells have it; 0 without one.
int interruptionCode();

/// "SIGINT"
std::string interruptionName();

/// While one exists, the first signal is only recorded, so that what was done so far can be
/// written; the second one ends the process at once.
class OrderlyEnd
{
public:
    /// stop: called from a thread of its own when the signal comes, and again every few
    /// milliseconds, as what it stops may only be about to begin. May be empty.
    explicit OrderlyEnd(std::function<void()> stop = {});
    ~OrderlyEnd(); ///< stop is called no more

    OrderlyEnd(const OrderlyEnd&) = delete;
    OrderlyEnd& operator=(const OrderlyEnd&) = delete;

private:
    void watch(const std::function<void()>& stop);

    std::mutex _mutex;
    std::condition_variable _wakeUp;
    bool _over = false; ///< guarded by _mutex
    std::thread _thread;
};

} // namespace osgRayTrace::app
