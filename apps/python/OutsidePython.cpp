// OutsidePython.cpp - counts the threads that are outside, and ends them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "OutsidePython.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

namespace osgRayTrace::python
{

namespace
{

constexpr std::chrono::milliseconds kInterval(10);

/// Holds what the threads outside and the one that ends the interpreter share.
struct Shared
{
    std::mutex mutex; ///< guards the other members
    std::condition_variable changed;
    int outside = 0;
    std::thread::id ender; ///< thread that ends the interpreter; none until then
    std::set<Renderer*> renders;
};

/// Is never destroyed: threads may wait to the very end of the process.
Shared& shared()
{
    static Shared& instance = *new Shared;
    return instance;
}

/// Returns whether the calling thread must not enter the interpreter again. The mutex is locked.
bool isTooLate(const Shared& state)
{
    return state.ender != std::thread::id() && state.ender != std::this_thread::get_id();
}

[[noreturn]] void waitForTheEnd()
{
    for (;;)
        std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Counts a thread that is outside no more.
void leave(Shared& state)
{
    --state.outside;
    state.changed.notify_all();
}

} // namespace

OutsidePython::OutsidePython()
{
    Shared& state = shared();
    _state = PyEval_SaveThread();
    std::unique_lock<std::mutex> lock(state.mutex);
    if (!isTooLate(state))
    {
        ++state.outside;
        return;
    }
    lock.unlock();
    waitForTheEnd();
}

OutsidePython::~OutsidePython()
{
    Shared& state = shared();
    {
        std::unique_lock<std::mutex> lock(state.mutex);
        if (isTooLate(state))
        {
            leave(state);
            lock.unlock();
            waitForTheEnd();
        }
    }
    PyEval_RestoreThread(_state); // endAll() still waits for this thread
    const std::lock_guard<std::mutex> lock(state.mutex);
    leave(state);
}

bool OutsidePython::isEnding()
{
    const std::lock_guard<std::mutex> lock(shared().mutex);
    return isTooLate(shared());
}

void OutsidePython::endAll()
{
    const pybind11::gil_scoped_release release;
    Shared& state = shared();
    std::unique_lock<std::mutex> lock(state.mutex);
    state.ender = std::this_thread::get_id();
    while (state.outside > 0)
    {
        for (Renderer* renderer : state.renders)
            renderer->cancel(); // a render that only begins forgets it: hence in each round
        state.changed.wait_for(lock, kInterval);
    }
}

StoppableRender::StoppableRender(Renderer& renderer) : _renderer(renderer)
{
    const std::lock_guard<std::mutex> lock(shared().mutex);
    shared().renders.insert(&renderer);
}

StoppableRender::~StoppableRender()
{
    const std::lock_guard<std::mutex> lock(shared().mutex);
    shared().renders.erase(&_renderer);
}

} // namespace osgRayTrace::python
