// Interruption.cpp - signal handlers, which only touch atomics and unlink. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Interruption.h"

#include "osgRayTrace/base/OutputFile.h"
#include "osgRayTrace/base/TemporaryFile.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>

namespace osgRayTrace::app
{

namespace
{

constexpr std::array kEnding{SIGINT, SIGTERM, SIGHUP, SIGUSR1};
constexpr std::array kCrashing{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGQUIT, SIGSEGV, SIGXCPU};
constexpr std::chrono::milliseconds kInterval(20);

std::atomic<int> cameSignal{0};
std::atomic<int> orderlyEnds{0};
static_assert(std::atomic<int>::is_always_lock_free, "signal handlers use them");

struct sigaction beforeOurs[NSIG]; ///< actions for kCrashing before ours

extern "C" void endBySignal(int signal)
{
    int none = 0;
    if (orderlyEnds > 0 && cameSignal.compare_exchange_strong(none, signal)) return;
    engine::removeTemporaryFiles();
    _exit(128 + signal);
}

/// Removes temporary files and leaves the signal to whoever would have had it: the system, or a
/// sanitizer.
extern "C" void crashBySignal(int signal)
{
    engine::removeTemporaryFiles();
    sigaction(signal, &beforeOurs[signal], nullptr);
    raise(signal);
}

bool isIgnored(int signal)
{
    struct sigaction now;
    return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

} // namespace

void handleSignals()
{
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    action.sa_handler = endBySignal;
    for (const int signal : kEnding)
        if (!isIgnored(signal)) sigaction(signal, &action, nullptr); // nohup has signals ignored
    action.sa_handler = crashBySignal;
    for (const int signal : kCrashing)
        if (!isIgnored(signal)) sigaction(signal, &action, &beforeOurs[signal]);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

bool isInterrupted()
{
    return cameSignal != 0;
}

int interruptionCode()
{
    return cameSignal == 0 ? 0 : 128 + cameSignal;
}

std::string interruptionName()
{
    switch (cameSignal)
    {
    case SIGINT:
        return "SIGINT";
    case SIGTERM:
        return "SIGTERM";
    case SIGHUP:
        return "SIGHUP";
    case SIGUSR1:
        return "SIGUSR1";
    default:
        return "";
    }
}

OrderlyEnd::OrderlyEnd(std::function<void()> stop)
{
    ++orderlyEnds;
    if (stop) _thread = std::thread([this, stop = std::move(stop)] { watch(stop); });
}

OrderlyEnd::~OrderlyEnd()
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _over = true;
    }
    _wakeUp.notify_one();
    if (_thread.joinable()) _thread.join();
    --orderlyEnds;
}

void OrderlyEnd::watch(const std::function<void()>& stop)
{
    std::unique_lock<std::mutex> lock(_mutex);
    while (!_wakeUp.wait_for(lock, kInterval, [this] { return _over; }))
        if (isInterrupted()) stop();
}

} // namespace osgRayTrace::app
