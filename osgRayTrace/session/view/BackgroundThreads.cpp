// BackgroundThreads.cpp - threads that end before the process does in order. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/BackgroundThreads.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <atomic>
#include <cstdlib>
#include <list>
#include <memory>
#include <mutex>
#include <thread>

namespace osgRayTrace::engine
{

namespace
{

struct BackgroundThread
{
    std::thread thread;
    std::function<void()> stop;
    std::shared_ptr<std::atomic<bool>> ended; ///< the body has returned and is destroyed
};

struct Threads
{
    std::mutex mutex; // held by whoever starts a thread, and by exit()
    std::list<BackgroundThread> all;
    bool exiting = false;
};

Threads& threads()
{
    static NeverDestroyed<Threads> all;
    return *all;
}

void endAll()
{
    std::list<BackgroundThread> all;
    {
        std::lock_guard<std::mutex> lock(threads().mutex);
        threads().exiting = true;
        all.swap(threads().all);
    }
    for (BackgroundThread& one : all)
        one.stop();
    for (BackgroundThread& one : all)
    {
        if (one.thread.get_id() == std::this_thread::get_id())
            one.thread.detach(); // this thread calls exit()
        else
            one.thread.join();
    }
}

} // namespace

bool startBackgroundThread(std::function<void()> body, std::function<void()> stop)
{
    std::lock_guard<std::mutex> lock(threads().mutex);
    if (threads().exiting) return false;
    [[maybe_unused]] static const int registered = std::atexit(endAll);

    std::list<BackgroundThread>& all = threads().all;
    for (auto one = all.begin(); one != all.end();)
    {
        const bool ended = *one->ended;
        if (ended) one->thread.join();
        one = ended ? all.erase(one) : std::next(one);
    }

    std::list<BackgroundThread> added(1);
    BackgroundThread& one = added.front();
    one.stop = std::move(stop);
    one.ended = std::make_shared<std::atomic<bool>>(false);
    one.thread = std::thread(
        [body = std::move(body), ended = one.ended]() mutable
        {
            body();
            body = nullptr;
            *ended = true;
        });
    all.splice(all.end(), added);
    return true;
}

} // namespace osgRayTrace::engine
