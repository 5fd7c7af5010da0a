// PassWorker.h - a rank makes passes on a thread of its own. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/Group.h"
#include "osgRayTrace/film/PassSums.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace osgRayTrace::app
{

/// What makes the passes: a Renderer, or a test. All but cancel is called on the worker's thread.
struct PassWork
{
    int width = 0;
    int height = 0;
    std::string host;      ///< the machine's name
    Processors processors; ///< of this process

    /// Makes the passes that next returns, until it is negative or goesOn, called after each pass,
    /// returns false. Returns why that failed; empty if it did not. Never throws.
    std::function<std::string(const std::function<int()>& next,
                              const std::function<bool()>& goesOn)>
        make;
    /// Returns the text that names the picture; called with next.
    std::function<std::string()> picture;
    /// Returns the sums of all passes made so far; nothing if memory is short.
    std::function<std::optional<engine::PassSums>()> sums;
    std::function<RayTotals()> rays;
    /// Ends a pass at work.
    std::function<void()> cancel;
};

/// Makes the passes that rank 0 tells. The thread that makes them and the one that speaks to other
/// ranks are two: rank 0 answers while it renders.
class PassWorker
{
public:
    using Clock = std::chrono::steady_clock;
    using Send = std::function<void(const GroupMessage&)>; ///< to rank 0

    /// Begins. The references are valid as long as the worker.
    PassWorker(Group& group, PassWork work, Send send);
    ~PassWorker();
    PassWorker(const PassWorker&) = delete;
    PassWorker& operator=(const PassWorker&) = delete;

    /// Takes a message of rank 0.
    void take(const GroupMessage& message);

    /// Sends what there is to say, and goes on with the sum at work. Returns whether there was
    /// anything to do.
    bool poll();

    /// Returns whether a sum is at work, which all ranks have to end.
    bool isSumming() const { return _summing; }

    /// Returns the sum of all ranks when it is there, once; only rank 0's is one. Its passes are
    /// those of rank 0.
    std::optional<engine::PassSums> takeSum();

    /// Waits until the thread has something to say, at most so long.
    void waitForNews(std::chrono::microseconds most);

private:
    void beginSum(const GroupMessage& message);
    void addNext();
    void run();
    int nextPass();
    bool goesOn();
    void makeReady(int round);
    void report(GroupMessage message);
    void fail(const std::string& problem);

    Group& _group;
    const PassWork _work;
    const Send _send;

    // The communicating thread's.
    bool _summing = false;
    std::optional<engine::PassSums> _sum;
    std::deque<std::vector<std::int64_t>*> _waiting; ///< arrays of sums to be added
    int _depthRank = 0;                ///< whose depths are to be added then; 0: nobody's
    std::vector<std::int64_t> _depths; ///< rank 0's, if they are another rank's

    // The working thread's.
    bool _greeted = false;
    bool _hasAsked = false;
    int _next = 0; ///< next pass of the lease
    int _leaseFirst = 0, _leaseEnd = 0;
    bool _atWork = false; ///< whether the time of the pass before _next was not counted yet
    Clock::time_point _passBegin;
    double _passSeconds = 0.0;  ///< time of the last pass of any kind
    double _leaseSeconds = 0.0; ///< time of the passes of the lease

    /// Shared by both threads.
    struct
    {
        std::mutex mutex;
        std::condition_variable orders, news;
        std::deque<GroupMessage> given;       ///< Take and Round, in their order
        std::deque<GroupMessage> said;        ///< to be sent
        std::optional<engine::PassSums> sums; ///< for the round
        bool leavesRest = false;              ///< no pass is begun any more
        bool isOver = false;
    } _shared;

    std::thread _thread; ///< the last member: it uses all others
};

} // namespace osgRayTrace::app
