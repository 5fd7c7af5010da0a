// CountedMemory.cpp - a program's operator new, which can be told to fail. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"

#include <link.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace osgRayTrace::test
{

namespace
{

std::atomic<int64_t> live{0}, untilFailure{0};
std::atomic<std::size_t> bytes{0}, mostBytes{0}, largest{0};
std::atomic<bool> armed{false}, onward{false}, happened{false};

struct AddressRange
{
    uintptr_t begin = 0, end = 0;
};
AddressRange drivers[16]; // written before the failure is armed, only read while it is armed

void addDriver(const dl_phdr_info& info)
{
    // If an operator new fails within Embree's parallel build, Embree 3.13.5 frees memory that it
    // still uses (one run in fifteen crashed in rtcReleaseDevice). So Embree is refused memory by
    // its memory monitor instead.
    for (const char* name :
         {"libLLVM", "libOSMesa", "swrast_dri", "libGL", "libEGL", "libembree", "libtbb"})
    {
        if (!std::strstr(info.dlpi_name, name)) continue;
        AddressRange* free =
            std::find_if(drivers, drivers + 15, [](auto& r) { return r.end == 0; });
        free->begin = info.dlpi_addr;
        for (int i = 0; i < info.dlpi_phnum; ++i)
            free->end = std::max<uintptr_t>(free->end, info.dlpi_addr + info.dlpi_phdr[i].p_vaddr +
                                                           info.dlpi_phdr[i].p_memsz);
        return;
    }
}

bool isDriver(const void* caller)
{
    const auto address = reinterpret_cast<uintptr_t>(caller);
    return std::any_of(drivers, drivers + 16,
                       [&](const AddressRange& r)
                       { return address >= r.begin && address < r.end; });
}

bool mustFail(const void* caller)
{
    if (!armed || isDriver(caller)) return false;
    const int64_t left = untilFailure.fetch_sub(1);
    if (left > 0 || (left < 0 && !onward)) return false;
    happened = true;
    return true;
}

void raise(std::atomic<std::size_t>& most, std::size_t value)
{
    std::size_t old = most;
    while (old < value && !most.compare_exchange_weak(old, value))
    {
    }
}

void* allocate(std::size_t size, std::size_t alignment, const void* caller)
{
    if (mustFail(caller)) return nullptr;
    raise(largest, size);
    void* memory = nullptr;
    if (alignment <= alignof(std::max_align_t))
        memory = std::malloc(std::max<std::size_t>(size, 1));
    else if (posix_memalign(&memory, alignment, std::max<std::size_t>(size, 1)) != 0)
        memory = nullptr;
    if (!memory) return nullptr;
    ++live;
    raise(mostBytes, bytes += malloc_usable_size(memory));
    return memory;
}

void* allocateOrThrow(std::size_t size, std::size_t alignment, const void* caller)
{
    if (void* memory = allocate(size, alignment, caller)) return memory;
    throw std::bad_alloc();
}

void release(void* memory)
{
    if (!memory) return;
    --live;
    bytes -= malloc_usable_size(memory);
    std::free(memory);
}

} // namespace

FailingMemory::FailingMemory(int64_t n, Failing failing)
{
    std::fill(drivers, drivers + 16, AddressRange());
    dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void*)
        {
            addDriver(*info);
            return 0;
        },
        nullptr);
    untilFailure = n;
    onward = failing == Failing::Onward;
    happened = false;
    armed = true;
}

FailingMemory::~FailingMemory()
{
    armed = false;
}

bool FailingMemory::failed() const
{
    return happened;
}

int64_t liveAllocations()
{
    return live;
}

MemoryPeak takeMemoryPeak()
{
    const MemoryPeak peak{largest.exchange(0), mostBytes.exchange(bytes)};
    return peak;
}

} // namespace osgRayTrace::test

using osgRayTrace::test::allocate;
using osgRayTrace::test::allocateOrThrow;
using osgRayTrace::test::release;

#define CALLER __builtin_return_address(0)
constexpr std::size_t kUsual = alignof(std::max_align_t);

void* operator new(std::size_t size)
{
    return allocateOrThrow(size, kUsual, CALLER);
}
void* operator new[](std::size_t size)
{
    return allocateOrThrow(size, kUsual, CALLER);
}
void* operator new(std::size_t size, std::align_val_t a)
{
    return allocateOrThrow(size, std::size_t(a), CALLER);
}
void* operator new[](std::size_t size, std::align_val_t a)
{
    return allocateOrThrow(size, std::size_t(a), CALLER);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    return allocate(size, kUsual, CALLER);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept
{
    return allocate(size, kUsual, CALLER);
}
void operator delete(void* memory) noexcept
{
    release(memory);
}
void operator delete[](void* memory) noexcept
{
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept
{
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
    release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept
{
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
    release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept
{
    release(memory);
}
