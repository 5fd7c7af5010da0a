// LargeArray.h - big arrays that are written once a frame. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace osgRayTrace::engine
{

/// Zeros in values, size of them, on huge pages where the system has some to spare: a frame writes each
/// tile's part at once, and with small pages each would miss the translation buffer. Throws std::bad_alloc.
template <class T> void allocateLarge(std::vector<T>& values, std::size_t size)
{
    std::vector<T>().swap(values);
    values.reserve(size);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr uintptr_t kPage = 4096;
    const uintptr_t begin = (reinterpret_cast<uintptr_t>(values.data()) + kPage - 1) & ~(kPage - 1);
    const uintptr_t end = reinterpret_cast<uintptr_t>(values.data() + size) & ~(kPage - 1);
    // Only a hint: where it is refused the pages are small.
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
    values.resize(size);
}

} // namespace osgRayTrace::engine
