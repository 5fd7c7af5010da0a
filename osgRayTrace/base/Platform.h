// Platform.h - what each operating system does in a way of its own. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#if defined(_WIN32)
#include <malloc.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>
#endif
#if defined(__APPLE__)
#include <mach-o/dyld.h>

#include <climits>
#endif

namespace osgRayTrace::engine
{

/// Returns memory for freeAligned(); null if there is none. bytes: a multiple of the alignment, a
/// power of two.
inline void* allocateAligned(std::size_t alignment, std::size_t bytes)
{
#if defined(_WIN32)
    return _aligned_malloc(bytes, alignment);
#else
    return std::aligned_alloc(alignment, bytes);
#endif
}

inline void freeAligned(void* memory)
{
#if defined(_WIN32)
    _aligned_free(memory);
#else
    std::free(memory);
#endif
}

/// Asks for huge pages in place of the whole pages of this memory. If the system refuses, or does
/// not know them, the pages are small.
inline void preferHugePages(void* memory, std::size_t bytes)
{
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr uintptr_t kPage = 4096;
    const uintptr_t begin = (reinterpret_cast<uintptr_t>(memory) + kPage - 1) & ~(kPage - 1);
    const uintptr_t end = (reinterpret_cast<uintptr_t>(memory) + bytes) & ~(kPage - 1);
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#else
    static_cast<void>(memory);
    static_cast<void>(bytes);
#endif
}

/// Returns the file of the program that runs; nothing if it is not known.
inline std::filesystem::path programPath()
{
    std::error_code error;
#if defined(__APPLE__)
    char path[PATH_MAX];
    uint32_t size = sizeof path;
    if (_NSGetExecutablePath(path, &size) != 0) return {};
    return std::filesystem::canonical(path, error);
#elif defined(_WIN32)
    return std::filesystem::canonical(_pgmptr, error);
#else
    return std::filesystem::read_symlink("/proc/self/exe", error);
#endif
}

} // namespace osgRayTrace::engine
