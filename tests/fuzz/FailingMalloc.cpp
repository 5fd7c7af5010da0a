// FailingMalloc.cpp - preloaded, it makes the C library's allocations fail for good. Layer: tests.
// SPDX-License-Identifier: MIT
//
// From allocation number OSGRAYTRACE_FAIL_FROM of the process on, all allocations fail, whoever
// asks for them. At its end the process writes their number to the file OSGRAYTRACE_COUNT_TO,
// unless a child of the process has written it.
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

extern "C"
{
    // The GNU C library's own functions, of which malloc and its family are other names.
    void* __libc_malloc(std::size_t size);
    void* __libc_calloc(std::size_t count, std::size_t size);
    void* __libc_realloc(void* memory, std::size_t size);
    void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace
{

std::atomic<long> allocations{0};

bool fails()
{
    // The variable has a constant initializer, because a guarded one might allocate: threads that
    // come here at once compute the same value.
    static std::atomic<long> from{-1};
    if (from < 0)
    {
        const char* text = std::getenv("OSGRAYTRACE_FAIL_FROM");
        from = text ? std::atol(text) : 0x7fffffffffffL;
    }
    if (++allocations <= from) return false;
    errno = ENOMEM;
    return true;
}

__attribute__((destructor)) void writeCount()
{
    const char* path = std::getenv("OSGRAYTRACE_COUNT_TO");
    const int file = path ? ::open(path, O_WRONLY | O_CREAT | O_EXCL, 0644) : -1;
    if (file < 0) return;
    char text[32];
    const int length = std::snprintf(text, sizeof(text), "%ld\n", allocations.load());
    if (::write(file, text, static_cast<std::size_t>(length)) != length) ::_exit(99);
    ::close(file);
}

} // namespace

extern "C"
{
    __attribute__((visibility("default"))) void* malloc(std::size_t size)
    {
        return fails() ? nullptr : __libc_malloc(size);
    }

    __attribute__((visibility("default"))) void* calloc(std::size_t count, std::size_t size)
    {
        return fails() ? nullptr : __libc_calloc(count, size);
    }

    __attribute__((visibility("default"))) void* realloc(void* memory, std::size_t size)
    {
        return fails() ? nullptr : __libc_realloc(memory, size);
    }

    __attribute__((visibility("default"))) void* memalign(std::size_t alignment, std::size_t size)
    {
        return fails() ? nullptr : __libc_memalign(alignment, size);
    }

    __attribute__((visibility("default"))) void* aligned_alloc(std::size_t alignment,
                                                               std::size_t size)
    {
        return memalign(alignment, size);
    }

    __attribute__((visibility("default"))) int posix_memalign(void** memory, std::size_t alignment,
                                                              std::size_t size)
    {
        *memory = memalign(alignment, size);
        return *memory ? 0 : ENOMEM;
    }
}
