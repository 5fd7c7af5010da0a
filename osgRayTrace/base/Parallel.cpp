// Parallel.cpp - the threads that a render uses; the one file that includes TBB. Layer: base.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/Parallel.h"

#include "osgRayTrace/base/Cpu.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace osgRayTrace::engine
{

namespace
{

/// Tells ThreadSanitizer an order that it cannot see in a TBB that is not sanitized. Everything
/// before a loop happens before the bodies of the loop, and the bodies happen before everything
/// after the loop; between bodies there is no order. The order holds for
/// run(), too, whose body another thread of a busy arena may take over.
class LoopOrder
{
public:
#if defined(__SANITIZE_THREAD__)
    LoopOrder()
    {
        __tsan_release(&_begin);
    }
    ~LoopOrder()
    {
        __tsan_acquire(&_end);
    }
    void enterBody()
    {
        __tsan_acquire(&_begin);
    }
    void leaveBody()
    {
        __tsan_release(&_end);
    }

private:
    char _begin = 0, _end = 0;
#else
    void enterBody() {}
    void leaveBody() {}
#endif
};

/// Marks a body of a loop for its lifetime, whether the body returns or throws.
class OrderedBody
{
public:
    explicit OrderedBody(LoopOrder& order) : _order(order) { _order.enterBody(); }
    ~OrderedBody() { _order.leaveBody(); }

private:
    LoopOrder& _order;
};

/// The number of callers that may be in the arena at once beside its own threads. A caller without
/// a place would have to wait for the loops of others: a scene could not be updated while a view is
/// traced in the background.
constexpr int kCallers = 8;

} // namespace

struct Workers::Implementation
{
    explicit Implementation(int count)
        : threads(count > 0 ? count : tbb::info::default_concurrency()),
          arena(threads - 1 + kCallers, kCallers)
    {
    }
    int threads;
    tbb::task_arena arena;
};

Workers::Workers(int threads) : _implementation(std::make_unique<Implementation>(threads))
{
    _implementation->arena.initialize();
}

Workers::~Workers() = default;

int Workers::threads() const
{
    return _implementation->threads;
}

void Workers::forEach(std::size_t count, const std::function<void(std::size_t)>& body) const
{
    // Ranges are short enough that no thread waits long for the last one, and long enough to cost
    // nothing.
    constexpr std::size_t kRangesPerThread = 128;
    const std::size_t grain =
        std::max<std::size_t>(1, count / (kRangesPerThread * static_cast<std::size_t>(threads())));
    LoopOrder order;
    _implementation->arena.execute(
        [&]
        {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, count, grain),
                [&](const tbb::blocked_range<std::size_t>& range)
                {
                    FlushDenormals flush;
                    const OrderedBody inOrder(order);
                    for (std::size_t i = range.begin(); i != range.end(); ++i)
                        body(i);
                },
                tbb::simple_partitioner());
        });
}

void Workers::run(const std::function<void()>& body) const
{
    LoopOrder order;
    _implementation->arena.execute(
        [&]
        {
            FlushDenormals flush;
            const OrderedBody inOrder(order);
            body();
        });
}

void forEachPart(const Workers* workers, std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body)
{
    const std::size_t parts = (count + grain - 1) / grain;
    const auto part = [&](std::size_t k) { body(k * grain, std::min(count, (k + 1) * grain)); };
    if (workers && parts > 1)
        workers->forEach(parts, part);
    else
        for (std::size_t k = 0; k < parts; ++k)
            part(k);
}

} // namespace osgRayTrace::engine
