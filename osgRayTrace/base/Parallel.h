// Parallel.h - the threads that a render uses, apart from the host's own. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace osgRayTrace::engine
{

/// An arena of worker threads. The host's TBB limits, thread affinities and floating-point modes
/// stay as they are: denormals are flushed only while a body runs. The class is thread safe:
/// several callers share the workers, each caller works on its own loop meanwhile, and no caller
/// waits for the loop of another.
class Workers
{
public:
    /// Makes an arena of so many threads: 0 takes all that the machine has; other numbers are at
    /// least 1 and include the calling thread. Threads that call at the same time come on top.
    explicit Workers(int threads = 0);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    int threads() const;

    /// Calls body(i) for each i in [0,count), in any order and on any of the threads. Returns when
    /// all bodies are done. The first exception of a body is rethrown, and bodies that have not
    /// begun are skipped.
    void forEach(std::size_t count, const std::function<void(std::size_t)>& body) const;

    /// Runs body once inside the arena, so that libraries that use TBB (Embree) stay within the
    /// arena.
    void run(const std::function<void()>& body) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

/// Calls body(begin, end) for the parts of [0,count) that hold grain indices each, the last one
/// perhaps fewer, on the workers; in order on the calling thread if they are null.
void forEachPart(const Workers* workers, std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t, std::size_t)>& body);

} // namespace osgRayTrace::engine
