// Parallel.h - the threads that a render uses, apart from the host's own. Layer: base.
// Parallel.cpp alone includes TBB.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace osgRayTrace::engine
{

/// An arena of worker threads. The host's TBB limits, thread affinities and floating-point modes
/// are left as they are: denormals are flushed only while a body runs. Thread safe: several callers
/// share the workers, each works for itself meanwhile, and none waits for the loop of another.
class Workers
{
public:
    /// threads: 0 takes all that the machine has; otherwise at least 1, the calling thread
    /// included; other threads that call at the same time come on top of them.
    explicit Workers(int threads = 0);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    int threads() const;

    /// Calls body(i) for each i in [0,count), any order, any of the threads; returns when all are
    /// done. The first exception of a body is rethrown here, and the bodies not yet begun are
    /// skipped.
    void forEach(std::size_t count, const std::function<void(std::size_t)>& body) const;

    /// Runs body once inside the arena, so that libraries that use TBB (Embree) stay within it.
    void run(const std::function<void()>& body) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
