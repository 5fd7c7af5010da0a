// ThreadSeam.h - asserts that one thread at a time uses what is not thread safe. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"

#include <atomic>
#include <thread>

namespace osgRayTrace::engine
{

/// A member of a class that one thread at a time may use. The thread that is inside may enter once
/// more. The class is empty if assertions are off.
template <bool kChecks> class BasicThreadSeam
{
public:
    class Entry
    {
    public:
        explicit Entry(BasicThreadSeam& seam) : _seam(seam)
        {
            const std::thread::id self = std::this_thread::get_id();
            std::thread::id none;
            if (!_seam._inside.compare_exchange_strong(none, self) && none != self)
                assertionFailed("one thread at a time is inside", __FILE__, __LINE__);
            ++_seam._depth;
        }
        ~Entry()
        {
            if (--_seam._depth == 0) _seam._inside.store(std::thread::id());
        }
        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;

    private:
        BasicThreadSeam& _seam;
    };

private:
    std::atomic<std::thread::id> _inside{};
    int _depth = 0; ///< number of entries of the thread inside
};

template <> class BasicThreadSeam<false>
{
public:
    struct Entry
    {
        explicit Entry(BasicThreadSeam&) {}
        ~Entry() {}
    };
};

#if defined(OSGRAYTRACE_ASSERTS)
using ThreadSeam = BasicThreadSeam<true>;
#else
using ThreadSeam = BasicThreadSeam<false>;
#endif

} // namespace osgRayTrace::engine
