// CountedMemory.h - a program's operator new, which can be told to fail. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace osgRayTrace::test
{

enum class Failing
{
    Once,  ///< one allocation fails, later ones succeed
    Onward ///< one allocation and all later ones fail
};

/// While an object of this class lives, the n-th allocation from now on (0 is the next), of any
/// thread, throws std::bad_alloc. At most one object may live at a time. Allocations of OpenGL's
/// drivers do not count, because the drivers are built without exceptions; nor do those of Embree
/// and TBB, which do not survive a failure.
class FailingMemory
{
public:
    explicit FailingMemory(int64_t n, Failing failing = Failing::Once);
    ~FailingMemory();

    /// Returns whether there was an n-th allocation.
    bool failed() const;
};

/// Returns how many allocations of operator new have not been deleted yet.
int64_t liveAllocations();

/// Holds the largest single allocation since the last call [bytes], and the largest sum of living
/// allocations since then.
struct MemoryPeak
{
    std::size_t single = 0, total = 0;
};
MemoryPeak takeMemoryPeak();

} // namespace osgRayTrace::test
