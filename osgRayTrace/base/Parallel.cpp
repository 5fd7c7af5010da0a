// Parallel.cpp - the threads that a render uses; the one file that includes TBB. Layer: base.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/Parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace osgRayTrace::engine
{

namespace
{

/// Flushes denormals while it lives: Embree wants it, and they cost time and bring nothing.
class FlushDenormals
{
public:
#if defined(__SSE__)
    FlushDenormals() : _saved(_mm_getcsr()) { _mm_setcsr(_saved | 0x8040u); }
    ~FlushDenormals() { _mm_setcsr(_saved); }

private:
    unsigned int _saved;
#endif
};

} // namespace

struct Workers::Implementation
{
    explicit Implementation(int threads) : arena(threads) {}
    tbb::task_arena arena;
};

Workers::Workers(int threads)
    : _implementation(
          std::make_unique<Implementation>(threads > 0 ? threads : +tbb::task_arena::automatic))
{
    _implementation->arena.initialize();
}

Workers::~Workers() = default;

int Workers::threads() const
{
    return _implementation->arena.max_concurrency();
}

void Workers::forEach(std::size_t count, const std::function<void(std::size_t)>& body) const
{
    _implementation->arena.execute(
        [&]
        {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, count, 1),
                [&](const tbb::blocked_range<std::size_t>& range)
                {
                    FlushDenormals flush;
                    for (std::size_t i = range.begin(); i != range.end(); ++i)
                        body(i);
                },
                tbb::simple_partitioner());
        });
}

void Workers::run(const std::function<void()>& body) const
{
    _implementation->arena.execute(
        [&]
        {
            FlushDenormals flush;
            body();
        });
}

} // namespace osgRayTrace::engine
