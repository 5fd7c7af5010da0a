// Cpu.h - which instructions the processor has. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::engine
{

/// Returns the level of the processor, as kernels are chosen by it: images of processors of one
/// level are equal bit by bit. "other" if this is not known.
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
#else
    return "other";
#endif
}

} // namespace osgRayTrace::engine
