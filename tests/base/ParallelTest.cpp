// ParallelTest.cpp - Workers do all of the work once and leave the host's settings alone.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/base/Parallel.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#if defined(__SSE__)
#include <immintrin.h>
#endif

using osgRayTrace::engine::Workers;

TEST_CASE("workers: forEach calls the body once for each index", "[base]")
{
    for (const int threads : {0, 1, 2})
    {
        const Workers workers(threads);
        for (const std::size_t count : {std::size_t(0), std::size_t(1), std::size_t(1000)})
        {
            std::vector<std::atomic<int>> calls(count);
            workers.forEach(count, [&](std::size_t i) { ++calls[i]; });
            for (const std::atomic<int>& n : calls)
                REQUIRE(n == 1);
        }
    }
}

TEST_CASE("workers: threads() is what was asked for, and at least 1 when all are wanted", "[base]")
{
    CHECK(Workers(1).threads() == 1);
    CHECK(Workers(2).threads() == 2);
    CHECK(Workers().threads() >= 1);
}

TEST_CASE("workers: no more bodies run at once than there are threads", "[base]")
{
    const Workers workers(2);
    std::atomic<int> running{0}, most{0};
    workers.forEach(200,
                    [&](std::size_t)
                    {
                        const int now = ++running;
                        int seen = most;
                        while (now > seen && !most.compare_exchange_weak(seen, now))
                        {
                        }
                        std::this_thread::yield();
                        --running;
                    });
    CHECK(most >= 1);
    CHECK(most <= 2);
}

TEST_CASE("workers: one thread means the calling thread", "[base]")
{
    const Workers workers(1);
    const std::thread::id caller = std::this_thread::get_id();
    bool elsewhere = false;
    workers.forEach(100, [&](std::size_t) { elsewhere |= std::this_thread::get_id() != caller; });
    CHECK_FALSE(elsewhere);
}

TEST_CASE("workers: the exception of a body is rethrown to the caller", "[base]")
{
    const Workers workers(2);
    std::atomic<int> begun{0};
    std::string message;
    try
    {
        workers.forEach(100000,
                        [&](std::size_t i)
                        {
                            ++begun;
                            if (i == 0) throw std::runtime_error("body 0");
                        });
    }
    catch (const std::runtime_error& error)
    {
        message = error.what();
    }
    CHECK(message == "body 0");
    CHECK(begun < 100000); // the rest was skipped
    REQUIRE_THROWS_AS(workers.run([] { throw std::logic_error("run"); }), std::logic_error);

    // The workers are usable again.
    std::atomic<int> calls{0};
    workers.forEach(10, [&](std::size_t) { ++calls; });
    CHECK(calls == 10);
}

TEST_CASE("workers: forEach within forEach, and within that of other workers", "[base]")
{
    const Workers outer(2), inner(2);
    std::vector<std::atomic<int>> calls(20 * 30);
    outer.forEach(20, [&](std::size_t i)
                  { outer.forEach(30, [&](std::size_t j) { ++calls[i * 30 + j]; }); });
    outer.forEach(20, [&](std::size_t i)
                  { inner.forEach(30, [&](std::size_t j) { ++calls[i * 30 + j]; }); });
    for (const std::atomic<int>& n : calls)
        REQUIRE(n == 2);
}

TEST_CASE("workers: nobody waits for the loop of another caller", "[base]")
{
    for (const int threads : {1, 2})
    {
        const Workers workers(threads);
        std::atomic<bool> free{false};
        std::atomic<int> held{0};
        std::thread other(
            [&]
            {
                workers.forEach(1000,
                                [&](std::size_t)
                                {
                                    ++held;
                                    while (!free)
                                        std::this_thread::yield();
                                });
            });
        while (held < threads)
            std::this_thread::yield();
        int calls = 0; // made by this thread: all others are held
        workers.run([&] { ++calls; });
        workers.forEach(1, [&](std::size_t) { ++calls; });
        CHECK(calls == 2);
        free = true;
        other.join();
    }
}

TEST_CASE("workers: several host threads may use the same workers at once", "[base]")
{
    const Workers workers(2);
    std::atomic<int> calls{0};
    std::vector<std::thread> hosts;
    for (int h = 0; h < 4; ++h)
        hosts.emplace_back([&] { workers.forEach(500, [&](std::size_t) { ++calls; }); });
    for (std::thread& host : hosts)
        host.join();
    CHECK(calls == 2000);
}

#if defined(__SSE__)
TEST_CASE("workers: the host's floating-point mode stands, denormals are flushed in bodies only",
          "[base]")
{
    constexpr unsigned int kRoundDown = 0x2000u;
    const unsigned int before = _mm_getcsr();
    for (const unsigned int mode : {before, before | kRoundDown})
    {
        _mm_setcsr(mode);
        const Workers workers(2);
        std::atomic<int> unflushed{0};
        workers.forEach(100,
                        [&](std::size_t) { unflushed += (_mm_getcsr() & 0x8040u) != 0x8040u; });
        const unsigned int afterForEach = _mm_getcsr();
        workers.run([&] { unflushed += (_mm_getcsr() & 0x8040u) != 0x8040u; });
        const unsigned int afterRun = _mm_getcsr();
        try
        {
            workers.forEach(10, [](std::size_t) { throw 1; });
        }
        catch (int)
        {
        }
        const unsigned int afterThrow = _mm_getcsr();
        _mm_setcsr(before);
        // Anything may raise exception flags, which are the low six bits.
        CHECK((afterForEach & ~0x3fu) == (mode & ~0x3fu));
        CHECK((afterRun & ~0x3fu) == (mode & ~0x3fu));
        CHECK((afterThrow & ~0x3fu) == (mode & ~0x3fu));
        CHECK(unflushed == 0);
    }
}
#endif

TEST_CASE("workers: the host's TBB limits stand", "[base]")
{
    const auto limit = []
    { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
    const std::size_t limitBefore = limit();
    const int arenaBefore = tbb::this_task_arena::max_concurrency();
    {
        const Workers workers(1);
        workers.forEach(100, [](std::size_t) {});
        CHECK(limit() == limitBefore);
        CHECK(tbb::this_task_arena::max_concurrency() == arenaBefore);
    }
    CHECK(limit() == limitBefore);
    CHECK(tbb::this_task_arena::max_concurrency() == arenaBefore);
}
