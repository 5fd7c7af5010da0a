// CheckedMutex.h - a mutex that can tell whether the calling thread holds it. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"

#include <atomic>
#include <mutex>
#include <thread>

namespace osgRayTrace::engine
{

/// A mutex for functions that want it locked and assert that: OSGRAYTRACE_ASSERT(_mutex.isHeld()).
/// It is a plain mutex if assertions are off.
template <bool kChecks> class BasicCheckedMutex
{
public:
    void lock()
    {
        _mutex.lock();
        _owner = std::this_thread::get_id();
    }

    bool try_lock()
    {
        if (!_mutex.try_lock()) return false;
        _owner = std::this_thread::get_id();
        return true;
    }

    void unlock()
    {
        _owner = std::thread::id();
        _mutex.unlock();
    }

    /// Returns whether the calling thread holds the mutex.
    bool isHeld() const { return _owner.load() == std::this_thread::get_id(); }

private:
    std::mutex _mutex;
    std::atomic<std::thread::id> _owner{};
};

template <> class BasicCheckedMutex<false> : public std::mutex
{
public:
    bool isHeld() const { return true; }
};

#if defined(OSGRAYTRACE_ASSERTS)
using CheckedMutex = BasicCheckedMutex<true>;
#else
using CheckedMutex = BasicCheckedMutex<false>;
#endif

} // namespace osgRayTrace::engine
