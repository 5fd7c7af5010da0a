// Interruption.h - Ctrl-C, SIGTERM, SIGHUP and SIGUSR1 as an orderly end. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace osgRayTrace::app
{

/// Takes over SIGINT, SIGTERM, SIGHUP and SIGUSR1, which job schedulers send before they stop a
/// job, unless they are ignored: outside of any OrderlyEnd they
/// end the process at once, with the code of interruptionCode(). These signals, and those of
/// crashes, remove temporary files first. Writing to a closed pipe or beyond a size limit becomes
/// an error of that write.
void handleSignals();

/// Returns whether one of the four signals has come. May be called from any thread.
bool isInterrupted();

/// Returns 128 and the signal's number, as shells do; 0 without a signal.
int interruptionCode();

/// Returns the name of the signal: "SIGINT".
std::string interruptionName();

/// Lets the first signal only be recorded while one exists, so that the results so far can be
/// written; the second signal ends the process at once.
class OrderlyEnd
{
public:
    /// Begins. stop: called from a thread of its own when the signal comes, and again every few
    /// milliseconds, because the work that it stops may only be about to begin. stop may be empty.
    explicit OrderlyEnd(std::function<void()> stop = {});
    ~OrderlyEnd(); ///< afterwards stop is called no more

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
