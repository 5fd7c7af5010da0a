// Kernel.h - loops as vector code, and functions for each vector width. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

/// OSGRAYTRACE_SIMD stands before a loop over lanes whose turns do not depend on each other.
#if defined(__GNUC__)
#define OSGRAYTRACE_PRAGMA(text) _Pragma(#text)
#define OSGRAYTRACE_SIMD OSGRAYTRACE_PRAGMA(omp simd)
/// OSGRAYTRACE_SIMD_OR stands before such a loop that also joins bits into the variable mask by |=.
#define OSGRAYTRACE_SIMD_OR(mask) OSGRAYTRACE_PRAGMA(omp simd reduction(| : mask))
#else
#define OSGRAYTRACE_SIMD
#define OSGRAYTRACE_SIMD_OR(mask)
#endif

/// OSGRAYTRACE_KERNEL stands before a function whose loops are worth a version for each vector
/// width. The loader picks the version for the CPU at hand, so a build for distribution uses
/// AVX-512 or AVX2 if the CPU has them. Loaders of ELF files alone can do that.
#if !defined(__x86_64__) || !defined(__ELF__) || !defined(__OPTIMIZE__) ||                         \
    defined(OSGRAYTRACE_NO_CLONES)
#define OSGRAYTRACE_KERNEL
#elif !defined(__clang__) || __clang_major__ >= 18
#define OSGRAYTRACE_KERNEL                                                                         \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
/// Before version 18, Clang takes a level for the name of a processor, which no CPU has, and clones
/// know one feature each. AVX-512VL implies AVX2 and FMA; there is no FMA with AVX2.
#define OSGRAYTRACE_KERNEL __attribute__((target_clones("avx512vl", "avx2", "default")))
#endif

/// OSGRAYTRACE_INLINE stands before a small function that must become part of the kernel that calls
/// it, and so use the kernel's vector width. OSGRAYTRACE_FLATTEN stands before a function that
/// takes in all that it calls.
#if defined(__GNUC__)
#define OSGRAYTRACE_INLINE inline __attribute__((always_inline))
#define OSGRAYTRACE_FLATTEN __attribute__((flatten))
#elif defined(_MSC_VER)
#define OSGRAYTRACE_INLINE __forceinline
#define OSGRAYTRACE_FLATTEN [[msvc::flatten]]
#else
#define OSGRAYTRACE_INLINE inline
#define OSGRAYTRACE_FLATTEN
#endif
