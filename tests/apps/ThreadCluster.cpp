// ThreadCluster.cpp - ranks as threads: work, hooks and loops.
// SPDX-License-Identifier: MIT
#include "tests/apps/ThreadCluster.h"

#include "osgRayTrace/sampling/Hash.h"

#include <memory>
#include <numeric>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::app;
using engine::PassSet;

namespace
{

/// Returns the sums of one pass: values below 2^31 * scale, the same for equal passes.
engine::PassSums sumsOfPass(int pass, std::int64_t scale)
{
    engine::PassSums sums;
    sums.width = kWidth;
    sums.height = kHeight;
    sums.passes.add(pass);
    sums.low.resize(engine::PassSums::kPlanes * sums.pixels());
    for (std::size_t i = 0; i < sums.low.size(); ++i)
        sums.low[i] = scale * (engine::hash(std::uint32_t(pass), std::uint32_t(i)) >> 1);
    sums.depth.assign(sums.pixels(), static_cast<float>(pass));
    return sums;
}

} // namespace

engine::PassSums sumsOf(const PassSet& passes, std::int64_t scale)
{
    engine::PassSums sums = sumsOfPass(passes.ranges().front().first, scale);
    for (const auto& [first, end] : passes.ranges())
        for (int pass = first; pass < end; ++pass)
            if (!sums.passes.contains(pass)) engine::addSums(sumsOfPass(pass, scale), sums);
    return sums;
}

bool areEqual(const engine::PassSums& a, const engine::PassSums& b)
{
    return a.passes == b.passes && a.low == b.low && a.high == b.high && a.depth == b.depth;
}

PassWork ThreadCluster::workOf(int number)
{
    const Rank rank = ranks[static_cast<std::size_t>(number)];
    const auto passes = std::make_shared<PassSet>();
    const auto spend = [rank]
    { std::this_thread::sleep_for(std::chrono::microseconds(rank.microseconds)); };
    PassWork work;
    work.width = kWidth;
    work.height = kHeight;
    work.host = rank.host;
    work.processors = rank.processors;
    work.make = [=](const auto& next, const auto& goesOn) -> std::string
    {
        int learnt = 0;
        for (int pass = next(); pass >= 0; pass = next())
        {
            if (rank.failsAtPass >= 0 && pass >= rank.failsAtPass)
            {
                _dead = rank.diesSilently;
                return rank.diesSilently ? "" : "a reason";
            }
            if (interruptedAtPass >= 0 && pass >= interruptedAtPass) _interrupted = true;
            for (; learnt < std::min(rank.learning, pass); ++learnt)
            {
                spend();
                if (!goesOn()) return "";
            }
            spend();
            passes->add(pass);
            ++made[static_cast<std::size_t>(number)];
            if (!goesOn()) return "";
        }
        return "";
    };
    work.picture = [rank] { return rank.picture; };
    work.sums = [=]() -> std::optional<engine::PassSums>
    { return passes->empty() ? engine::PassSums() : sumsOf(*passes, rank.scale); };
    work.rays = [passes] { return RayTotals{static_cast<std::uint64_t>(passes->count())}; };
    work.cancel = [this] { cancelled = true; };
    return work;
}

GroupHooks ThreadCluster::hooksOf(int rank)
{
    GroupHooks hooks;
    hooks.now = [this]
    {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        return clockRate * std::chrono::duration<double>(now).count();
    };
    hooks.isInterrupted = [this, rank] { return rank == interruptedRank && _interrupted.load(); };
    return hooks;
}

/// Is another rank than 0, on a thread of its own.
void ThreadCluster::help(ThreadNetwork& network, int rank)
{
    ThreadGroup group(network, rank);
    GroupHooks hooks = hooksOf(rank);
    const std::function<double()> now = hooks.now;
    if (ranks[static_cast<std::size_t>(rank)].diesSilently)
        hooks.now = [this, now, &network]
        {
            for (; _dead; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
                network.throwIfAborted();
            return now();
        };
    try
    {
        helpToRender(group, workOf(rank), hooks);
        waitForBye(group);
    }
    catch (const Aborted&)
    {
    }
}

GroupResult ThreadCluster::run()
{
    const int size = static_cast<int>(ranks.size());
    made.assign(ranks.size(), 0);
    ThreadNetwork network(size, seed, delay);
    std::vector<std::thread> helpers;
    for (int rank = 1; rank < size; ++rank)
        helpers.emplace_back([this, rank, &network] { help(network, rank); });
    const auto judge = [this](const engine::PassSums& sums, bool keeps)
    {
        if (keeps) kept.push_back(sums.passes);
        sumsAreRight = sumsAreRight && areEqual(sums, sumsOf(sums.passes, ranks[0].scale));
        return error ? error(sums.passes.count()) : 1.0;
    };
    GroupResult result;
    ThreadGroup group(network, 0);
    try
    {
        result = renderInGroup(group, workOf(0), plan, judge, hooksOf(0));
        sayBye(group);
    }
    catch (const Aborted& aborted)
    {
        result.exitCode = aborted.code;
        result.failure = "aborted";
    }
    for (std::thread& helper : helpers)
        helper.join();
    return result;
}

int ThreadCluster::allMade() const
{
    return std::accumulate(made.begin(), made.end(), 0);
}
