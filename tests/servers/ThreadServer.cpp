// ThreadServer.cpp - a render server on a thread, with a slow line and a short life. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/servers/ThreadServer.h"

#include "osgRayTrace/servers/TileServer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <random>
#include <thread>

namespace osgRayTrace::engine::test
{

namespace
{

using Clock = std::chrono::steady_clock;

struct Letter
{
    Clock::time_point due;
    Bytes message;
};

} // namespace

struct ThreadServer::Line
{
    std::mutex mutex; // the viewer and the server lock it
    std::deque<Letter> toServer, toViewer;
    bool dead = false;
    std::mt19937 random;
    double longestDelay = 0.0;

    void put(std::deque<Letter>& letters, const Bytes& message)
    {
        const double delay = longestDelay * (random() * 0x1p-32);
        Clock::time_point due =
            Clock::now() + std::chrono::microseconds(static_cast<int64_t>(1e6 * delay));
        if (!letters.empty()) due = std::max(due, letters.back().due);
        letters.push_back({due, message});
    }
    static bool takeFrom(std::deque<Letter>& letters, Bytes& message)
    {
        if (letters.empty() || letters.front().due > Clock::now()) return false;
        message = std::move(letters.front().message);
        letters.pop_front();
        return true;
    }
};

struct ThreadServer::Thread
{
    std::atomic<bool> ends{false};
    std::atomic<bool> dies{false};
    std::thread thread;
};

namespace
{

/// Returns the workers of all servers. They are made once, by the thread of the tests:
/// ThreadSanitizer does not see how TBB hands memory from one thread to another.
const std::shared_ptr<Workers>& workersOfAll()
{
    static const std::shared_ptr<Workers> workers = std::make_shared<Workers>(1);
    return workers;
}

template <class Line> class ThreadLink : public Link
{
public:
    explicit ThreadLink(std::shared_ptr<Line> line) : _line(std::move(line)) {}
    bool send(const Bytes& message) override
    {
        const std::lock_guard<std::mutex> lock(_line->mutex);
        if (_line->dead) return false;
        _line->put(_line->toServer, message);
        return true;
    }
    bool receive(Bytes& message) override
    {
        const std::lock_guard<std::mutex> lock(_line->mutex);
        return Line::takeFrom(_line->toViewer, message);
    }

private:
    std::shared_ptr<Line> _line;
};

} // namespace

ThreadServer::ThreadServer(const Fate& fate)
    : _line(std::make_shared<Line>()), _workers(workersOfAll()), _thread(std::make_unique<Thread>())
{
    _line->random.seed(fate.seed);
    _line->longestDelay = fate.longestDelay;
    _thread->thread = std::thread([this, fate] { run(fate); });
}

ThreadServer::~ThreadServer()
{
    _thread->ends = true;
    _thread->thread.join();
}

void ThreadServer::kill()
{
    _thread->dies = true;
}

std::unique_ptr<Link> ThreadServer::connect()
{
    return std::make_unique<ThreadLink<Line>>(_line);
}

void ThreadServer::run(const Fate& fate)
{
    const auto send = [this](const std::string&, Bytes&& message)
    {
        const std::lock_guard<std::mutex> lock(_line->mutex);
        if (!_line->dead) _line->put(_line->toViewer, message);
    };
    int traces = fate.traces, slowGroups = fate.slowGroups;
    while (!_thread->ends)
    {
        TileServer server(_workers, send);
        while (!_thread->ends && !_thread->dies && traces != 0)
        {
            Bytes message;
            bool came = true;
            while (came)
            {
                {
                    const std::lock_guard<std::mutex> lock(_line->mutex);
                    came = Line::takeFrom(_line->toServer, message);
                }
                if (came) server.take("viewer", message);
            }
            if (!server.work())
            {
                std::this_thread::sleep_for(std::chrono::microseconds(50));
                continue;
            }
            if (traces > 0) --traces;
            if (slowGroups-- <= 0) continue;
            std::this_thread::sleep_for(
                std::chrono::microseconds(static_cast<int64_t>(1e6 * fate.slowness)));
        }
        {
            const std::lock_guard<std::mutex> lock(_line->mutex);
            _line->dead = true;
            _line->toServer.clear();
        }
        if (!fate.returns) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        const std::lock_guard<std::mutex> lock(_line->mutex);
        _line->dead = false;
        traces = fate.traces;
        _thread->dies = false;
    }
}

} // namespace osgRayTrace::engine::test
