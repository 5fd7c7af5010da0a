// CheckedMutexTest.cpp - a mutex knows whether the calling thread holds it.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/CheckedMutex.h"

#include "tests/Catch.h"

using Mutex = osgRayTrace::engine::BasicCheckedMutex<true>;

namespace
{

struct Seen
{
    bool held = true, locked = true;
};

/// Returns what another thread learns of a mutex.
Seen seenByOther(Mutex& mutex)
{
    Seen seen;
    std::thread(
        [&]
        {
            seen.held = mutex.isHeld();
            seen.locked = mutex.try_lock();
            if (!seen.locked) return;
            seen.held = mutex.isHeld();
            mutex.unlock();
        })
        .join();
    return seen;
}

} // namespace

TEST_CASE("a checked mutex is held by the thread that has locked it, and by no other", "[base]")
{
    Mutex mutex;
    CHECK_FALSE(mutex.isHeld());
    {
        const std::lock_guard<Mutex> lock(mutex);
        CHECK(mutex.isHeld());
        const Seen seen = seenByOther(mutex);
        CHECK_FALSE(seen.held);
        CHECK_FALSE(seen.locked);
    }
    CHECK_FALSE(mutex.isHeld());
    const Seen seen = seenByOther(mutex);
    CHECK(seen.held);
    CHECK(seen.locked);
    CHECK_FALSE(mutex.isHeld());
    {
        const std::unique_lock<Mutex> lock(mutex, std::try_to_lock);
        CHECK(lock.owns_lock());
        CHECK(mutex.isHeld());
    }
}
