// CountedMemory.h - a program's operator new, which can be told to fail. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace osgRayTrace::test
{

enum class Failing
{
    Once,  ///< one allocation fails, those after it do not
    Onward ///< that one and all after it
};

/// While it lives the n-th allocation from now on (0 is the next), of any thread, throws
/// std::bad_alloc. At most one at a time. Not counted are those of OpenGL's drivers, which are
/// built without exceptions, and of Embree and TBB, which do not survive it.
class FailingMemory
{
public:
    explicit FailingMemory(int64_t n, Failing failing = Failing::Once);
    ~FailingMemory();

    /// True if there was an n-th allocation.
    bool failed() const;
};

/// Calls of operator new that are not deleted yet.
int64_t liveAllocations();

/// The largest single allocation since the last call [bytes], and the most that lived at once since
/// then.
struct MemoryPeak
{
    std::size_t single = 0, total = 0;
};
MemoryPeak takeMemoryPeak();

} // namespace osgRayTrace::test
