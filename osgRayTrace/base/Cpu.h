// Cpu.h - asks the processor what it has, and tells it what comes. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Kernel.h"

#if (defined(_MSC_VER) && defined(_M_X64)) || defined(__SSE2__)
#define OSGRAYTRACE_SSE
#include <immintrin.h>
#endif

#include <cstdint>

namespace osgRayTrace::engine
{

/// Returns the level of the processor, as kernels are chosen by it: images of processors of one
/// level are equal bit by bit. "aarch64", or "other" if this is not known.
inline const char* cpuLevel()
{
#if defined(__GNUC__) && defined(__x86_64__)
    __builtin_cpu_init();
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi2");
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    if (avx2 && avx512) return "x86-64-v4";
    return avx2 ? "x86-64-v3" : "x86-64";
#elif defined(_M_X64)
    return "x86-64";
#elif defined(__aarch64__) || defined(_M_ARM64)
    return "aarch64";
#else
    return "other";
#endif
}

/// Asks for memory that is soon read. A hint: the address may be any.
OSGRAYTRACE_INLINE void prefetch(const void* address)
{
#if defined(__GNUC__)
    __builtin_prefetch(address);
#elif defined(OSGRAYTRACE_SSE)
    _mm_prefetch(static_cast<const char*>(address), _MM_HINT_T0);
#else
    static_cast<void>(address);
#endif
}

/// Flushes this thread's denormals during its lifetime: Embree wants that, and denormals cost time
/// and bring nothing. On processors of other makers than those of x86-64 and aarch64 they stay.
class FlushDenormals
{
public:
    FlushDenormals() : _saved(control()) { setControl(_saved | kFlush); }
    ~FlushDenormals() { setControl(_saved); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
#if defined(OSGRAYTRACE_SSE)
    static constexpr unsigned kFlush = 0x8040u; ///< results and arguments
    static unsigned control()
    {
        return _mm_getcsr();
    }
    static void setControl(unsigned value)
    {
        _mm_setcsr(value);
    }

    unsigned _saved;
#elif defined(__aarch64__) && defined(__GNUC__)
    static constexpr uint64_t kFlush = uint64_t(1) << 24; ///< FZ
    static uint64_t control()
    {
        uint64_t value;
        __asm__ __volatile__("mrs %0, fpcr" : "=r"(value));
        return value;
    }
    static void setControl(uint64_t value)
    {
        __asm__ __volatile__("msr fpcr, %0" : : "r"(value));
    }

    uint64_t _saved;
#else
    static constexpr unsigned kFlush = 0;
    static unsigned control()
    {
        return 0;
    }
    static void setControl(unsigned) {}

    unsigned _saved;
#endif
};

} // namespace osgRayTrace::engine
