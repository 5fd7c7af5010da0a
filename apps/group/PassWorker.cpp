// PassWorker.cpp - leases, rounds and sums of one rank. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/PassWorker.h"

#include "osgRayTrace/base/Assert.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <utility>

namespace osgRayTrace::app
{

namespace
{

using Kind = GroupMessage::Kind;

double secondsBetween(PassWorker::Clock::time_point begin, PassWorker::Clock::time_point end)
{
    return std::chrono::duration<double>(end - begin).count();
}

/// Moves a part of large sums to the high part, so that those of all ranks can be added.
void makeRoom(engine::PassSums& sums, int ranks)
{
    // Sums of ExactSum's normal form are below 2^61.
    const std::int64_t most = (std::int64_t(1) << 61) / ranks;
    for (std::size_t i = 0; i < sums.low.size(); ++i)
    {
        std::int64_t& low = sums.low[i];
        if (low > -most && low < most) continue;
        if (sums.high.empty()) sums.high.assign(sums.low.size(), 0);
        const std::int64_t unit = std::int64_t(1) << 28; // 2^-12 in units of 2^-40
        sums.high[i] += low / unit;
        low %= unit;
    }
}

/// Writes the bits of depths as integers, whose sum with zeros is exact.
void depthsToBits(const std::vector<float>& depths, std::vector<std::int64_t>& bits)
{
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
        std::uint32_t word;
        std::memcpy(&word, &depths[i], sizeof(word));
        bits[i] = word;
    }
}

void bitsToDepths(const std::vector<std::int64_t>& bits, std::vector<float>& depths)
{
    for (std::size_t i = 0; i < depths.size(); ++i)
    {
        const auto word = static_cast<std::uint32_t>(bits[i]);
        std::memcpy(&depths[i], &word, sizeof(word));
    }
}

engine::PassSums noPasses(int width, int height)
{
    engine::PassSums sums;
    sums.width = width;
    sums.height = height;
    sums.low.assign(engine::PassSums::kPlanes * sums.pixels(), 0);
    sums.depth.assign(sums.pixels(), 1.0f);
    return sums;
}

} // namespace

PassWorker::PassWorker(Group& group, PassWork work, Send send)
    : _group(group), _work(std::move(work)), _send(std::move(send)), _thread([this] { run(); })
{
}

PassWorker::~PassWorker()
{
    take(GroupMessage(Kind::End));
    _thread.join();
}

void PassWorker::take(const GroupMessage& message)
{
    if (message.kind == Kind::Sum) return beginSum(message);
    const bool isEnd = message.kind == Kind::End;
    {
        const std::lock_guard<std::mutex> lock(_shared.mutex);
        if (isEnd) _shared.isOver = true;
        if (message.kind == Kind::Round && message.flag) _shared.leavesRest = true;
        if (message.kind == Kind::Take || message.kind == Kind::Round)
            _shared.given.push_back(message);
    }
    _shared.orders.notify_one();
    if (isEnd) _work.cancel();
}

/// Adds the sums of all ranks. The depths are those of one rank: all others add zeros, and nothing
/// is added if it is rank 0, which has them.
void PassWorker::beginSum(const GroupMessage& message)
{
    {
        const std::lock_guard<std::mutex> lock(_shared.mutex);
        _sum = std::move(_shared.sums);
        _shared.sums.reset();
    }
    OSGRAYTRACE_ASSERT(_sum);
    _waiting = {&_sum->low};
    if (message.flag)
    {
        _sum->high.resize(_sum->low.size(), 0);
        _waiting.push_back(&_sum->high);
    }
    _depthRank = message.first;
    // Rank 0 is the first that is told to add, so that there is still time to say what it lacks.
    if (_depthRank != 0 && _group.rank() == 0) _depths.resize(_sum->depth.size());
    addNext();
}

/// Begins to add the next array, if there is one. The depths are the last one: ranks but 0 have
/// sent their sums by then, and use their memory again.
void PassWorker::addNext()
{
    std::vector<std::int64_t>* values = nullptr;
    if (!_waiting.empty())
    {
        values = _waiting.front();
        _waiting.pop_front();
    }
    else if (const int from = std::exchange(_depthRank, 0))
    {
        values = _group.rank() == 0 ? &_depths : &_sum->low;
        values->assign(_sum->depth.size(), 0);
        if (_group.rank() == from) depthsToBits(_sum->depth, *values);
    }
    _summing = values != nullptr;
    if (_summing) _group.beginSum(values->data(), values->size());
}

bool PassWorker::poll()
{
    std::deque<GroupMessage> said;
    {
        const std::lock_guard<std::mutex> lock(_shared.mutex);
        said.swap(_shared.said);
    }
    for (const GroupMessage& message : said)
        _send(message);
    if (!_summing || !_group.sumIsDone()) return !said.empty() || _summing;
    addNext();
    if (!_summing && !_depths.empty())
    {
        bitsToDepths(_depths, _sum->depth);
        std::vector<std::int64_t>().swap(_depths);
    }
    return true;
}

std::optional<engine::PassSums> PassWorker::takeSum()
{
    std::optional<engine::PassSums> sum;
    if (!_summing) sum.swap(_sum);
    return sum;
}

void PassWorker::waitForNews(std::chrono::microseconds most)
{
    std::unique_lock<std::mutex> lock(_shared.mutex);
    _shared.news.wait_for(lock, most, [this] { return !_shared.said.empty(); });
}

void PassWorker::run()
{
    const std::string problem =
        _work.make([this] { return nextPass(); }, [this] { return goesOn(); });
    if (!problem.empty()) fail(problem);
    // The render is over, but rounds may still come. What is left of the lease is left for good.
    {
        const std::lock_guard<std::mutex> lock(_shared.mutex);
        _shared.leavesRest = true;
    }
    _greeted = _hasAsked = true;
    while (nextPass() >= 0)
    {
    }
}

/// Waits for the next pass and returns it; -1 if there is none any more.
int PassWorker::nextPass()
{
    if (_atWork) _leaseSeconds += _passSeconds;
    _atWork = false;
    if (!_greeted)
    {
        GroupMessage hello(Kind::Hello);
        hello.text = _work.picture();
        hello.host = _work.host;
        hello.processors = _work.processors;
        _greeted = _hasAsked = true;
        report(std::move(hello));
    }
    std::unique_lock<std::mutex> lock(_shared.mutex);
    while (!_shared.isOver)
    {
        if (_shared.leavesRest) _leaseEnd = _next;
        if (_next < _leaseEnd)
        {
            _atWork = true;
            _passBegin = Clock::now();
            return _next++;
        }
        if (!_shared.given.empty())
        {
            const GroupMessage order = _shared.given.front();
            _shared.given.pop_front();
            if (order.kind == Kind::Take)
            {
                _hasAsked = false;
                _leaseFirst = _next = order.first;
                _leaseEnd = order.end;
                _leaseSeconds = 0.0;
                continue;
            }
            lock.unlock();
            makeReady(order.first);
            lock.lock();
            continue;
        }
        if (!_hasAsked)
        {
            _hasAsked = true;
            lock.unlock();
            GroupMessage want(Kind::Want);
            want.first = _leaseFirst;
            want.end = _next;
            want.seconds = _leaseSeconds;
            want.rays = _work.rays();
            report(std::move(want));
            lock.lock();
            continue;
        }
        _shared.orders.wait(lock);
    }
    return -1;
}

/// Notes how long a pass took, which may be one that others depend on and that is of no lease.
bool PassWorker::goesOn()
{
    const Clock::time_point now = Clock::now();
    _passSeconds = secondsBetween(_passBegin, now);
    _passBegin = now;
    const std::lock_guard<std::mutex> lock(_shared.mutex);
    return !_shared.isOver && !_shared.leavesRest;
}

/// Copies the sums for a round.
void PassWorker::makeReady(int round)
{
    GroupMessage ready(Kind::Ready);
    ready.first = round;
    try
    {
        std::optional<engine::PassSums> sums = _work.sums();
        if (!sums) return fail("there is not enough memory");
        if (sums->passes.empty()) *sums = noPasses(_work.width, _work.height);
        makeRoom(*sums, _group.size());
        ready.flag = !sums->high.empty();
        ready.text = engine::passText(sums->passes);
        ready.rays = _work.rays();
        const std::lock_guard<std::mutex> lock(_shared.mutex);
        _shared.sums = std::move(sums);
    }
    catch (const std::exception& error)
    {
        return fail(error.what());
    }
    report(std::move(ready));
}

void PassWorker::report(GroupMessage message)
{
    {
        const std::lock_guard<std::mutex> lock(_shared.mutex);
        _shared.said.push_back(std::move(message));
    }
    _shared.news.notify_one();
}

void PassWorker::fail(const std::string& problem)
{
    GroupMessage failed(Kind::Failed);
    failed.text = problem;
    failed.host = _work.host;
    report(std::move(failed));
}

} // namespace osgRayTrace::app
