// SharedRender.cpp - the loops that carry messages between ranks and their threads. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/SharedRender.h"

#include "apps/group/Launcher.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

namespace osgRayTrace::app
{

namespace
{

using Kind = GroupMessage::Kind;
using std::chrono::microseconds;

constexpr int kCannotRender = 3;           ///< exit code
constexpr double kAliveInterval = 5.0;     ///< [s]
constexpr microseconds kShortestWait(100); ///< after something happened
constexpr microseconds kLongestWait(4000); ///< after a while without; a look costs some 30 us

/// Ends the group because a rank is dead. MPI alone would leave the others to the launcher, which
/// takes its time.
void abortAll(Group& group, const std::string& dead)
{
    std::fprintf(stderr, "osgraytrace: %s does not answer\n", dead.c_str());
    for (int rank = 1; rank < group.size(); ++rank)
        group.send(rank, GroupMessage(Kind::Abort));
    for (int i = 0; i < 10; ++i) // carries the messages
    {
        group.receive();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    group.abort(kCannotRender);
}

/// Waits longer, the longer nothing happens.
class Pace
{
public:
    void wait(PassWorker& worker, bool worked)
    {
        // Sums go on only while somebody looks at them, piece by piece. They take a second.
        if (worker.isSumming()) return std::this_thread::yield();
        _wait = worked ? kShortestWait : std::min(2 * _wait, kLongestWait);
        worker.waitForNews(_wait);
    }

private:
    microseconds _wait = kShortestWait;
};

} // namespace

GroupResult renderInGroup(Group& group, PassWork work, GroupPlan plan, Coordinator::Judge judge,
                          const GroupHooks& hooks)
{
    PassWorker* own = nullptr;
    const auto send = [&](int rank, const GroupMessage& message)
    {
        if (rank == 0)
            own->take(message);
        else
            group.send(rank, message);
    };
    Coordinator coordinator(group.size(), std::move(plan), send, std::move(judge));
    PassWorker worker(group, std::move(work),
                      [&](const GroupMessage& message)
                      { coordinator.take(0, message, hooks.now()); });
    own = &worker;
    bool noted = false;
    for (Pace pace; !coordinator.isOver() || worker.isSumming();)
    {
        bool worked = false;
        while (const auto received = group.receive())
        {
            coordinator.take(received->first, received->second, hooks.now());
            worked = true;
        }
        worked = worker.poll() || worked;
        if (auto sum = worker.takeSum()) coordinator.takeSum(std::move(*sum));
        const double now = hooks.now();
        worked = coordinator.poll(now, hooks.isInterrupted()) || worked;
        if (const auto silent = coordinator.silentRank(now))
            abortAll(group, coordinator.nameOf(*silent));
        const std::string& note = coordinator.result().note;
        if (!noted && !note.empty()) std::fprintf(stderr, "osgraytrace: %s\n", note.c_str());
        noted = noted || !note.empty();
        if (hooks.progress)
            hooks.progress(coordinator.passesDone(), coordinator.rays(), coordinator.seconds(now));
        if (!coordinator.isOver() || worker.isSumming()) pace.wait(worker, worked);
    }
    return coordinator.result();
}

void helpToRender(Group& group, PassWork work, const GroupHooks& hooks)
{
    PassWorker worker(group, std::move(work),
                      [&group](const GroupMessage& message) { group.send(0, message); });
    bool isOver = false;
    bool toldStop = false;
    double alive = hooks.now();
    for (Pace pace; !isOver || worker.isSumming();)
    {
        bool worked = false;
        while (const auto received = isOver ? std::nullopt : group.receive())
        {
            const GroupMessage& message = received->second;
            worker.take(message);
            isOver = message.kind == Kind::End;
            if (message.kind == Kind::Abort) group.abort(kCannotRender);
            if (message.kind == Kind::Alive) group.send(0, message); // rank 0 wants to know
            worked = true;
        }
        worked = worker.poll() || worked;
        worker.takeSum(); // is rank 0's alone
        const double now = hooks.now();
        if (now - alive > kAliveInterval)
        {
            group.send(0, GroupMessage(Kind::Alive));
            alive = now;
        }
        if (!toldStop && hooks.isInterrupted())
        {
            group.send(0, GroupMessage(Kind::Stop));
            toldStop = true;
        }
        if (!isOver || worker.isSumming()) pace.wait(worker, worked);
    }
}

void reportFailure(Group& group, int exitCode, const std::string& failure)
{
    GroupMessage failed(Kind::Failed);
    failed.first = exitCode;
    failed.text = failure;
    failed.host = hostName();
    group.send(0, failed);
}

void sayBye(Group& group)
{
    for (int rank = 1; rank < group.size(); ++rank)
    {
        group.send(rank, GroupMessage(Kind::End)); // if the render has not come to its end
        group.send(rank, GroupMessage(Kind::Bye));
    }
}

void waitForBye(Group& group)
{
    while (true)
    {
        const auto received = group.receive();
        if (received && received->second.kind == Kind::Bye) return;
        if (!received) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

} // namespace osgRayTrace::app
