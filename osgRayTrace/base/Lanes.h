// Lanes.h - plain arrays of sixteen values, and how loops over them become vector code. Layer:
// base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cstdint>
#include <cstring>

/// Before a loop over lanes whose turns do not depend on each other.
#if defined(__GNUC__)
#define OSGRAYTRACE_PRAGMA(text) _Pragma(#text)
#define OSGRAYTRACE_SIMD OSGRAYTRACE_PRAGMA(omp simd)
/// The same for loops that also or something into the variable mask.
#define OSGRAYTRACE_SIMD_OR(mask) OSGRAYTRACE_PRAGMA(omp simd reduction(| : mask))
#else
#define OSGRAYTRACE_SIMD
#define OSGRAYTRACE_SIMD_OR(mask)
#endif

/// Before a function whose loops are worth a version for each vector width; the loader picks one
/// for the CPU at hand, so a build for distribution uses AVX-512 or AVX2 where there is.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__OPTIMIZE__) &&    \
    !defined(OSGRAYTRACE_NO_CLONES)
#define OSGRAYTRACE_KERNEL                                                                         \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define OSGRAYTRACE_KERNEL
#endif

/// A small function that must become part of the kernel that calls it, and so of its vector width.
#if defined(__GNUC__)
#define OSGRAYTRACE_INLINE inline __attribute__((always_inline))
#else
#define OSGRAYTRACE_INLINE inline
#endif

namespace osgRayTrace::engine
{

/// Rays are traced and shaded sixteen at a time.
constexpr int kLanes = 16;

/// Bit i: lane i is in use.
using LaneMask = uint32_t;
constexpr LaneMask kAllLanes = 0xffffu;

/// One value for each lane.
template <class T> struct alignas(64) Lanes
{
    T v[kLanes];
    T& operator[](int lane) { return v[lane]; }
    const T& operator[](int lane) const { return v[lane]; }
};

using FloatLanes = Lanes<float>;
using UintLanes = Lanes<uint32_t>;

/// All bits set where the condition holds. Conditions are joined by & and | of these: compilers do
/// not vectorize a mix of conditions on floats and on integers.
OSGRAYTRACE_INLINE uint32_t maskOf(bool condition)
{
    return 0u - static_cast<uint32_t>(condition);
}

/// maskOf(lane i is in lanes)
OSGRAYTRACE_INLINE uint32_t laneBit(LaneMask lanes, int i)
{
    return 0u - ((lanes >> i) & 1u);
}

/// Bit i if mask is set in lane i.
OSGRAYTRACE_INLINE LaneMask bitOfLane(uint32_t mask, int i)
{
    return mask & (1u << i);
}

/// a where the mask is set, else b, without a branch that the compiler could move the making of a
/// or b into: that would keep the loop around it from being vectorized.
OSGRAYTRACE_INLINE float select(uint32_t mask, float a, float b)
{
    uint32_t bitsA, bitsB;
    std::memcpy(&bitsA, &a, sizeof(a));
    std::memcpy(&bitsB, &b, sizeof(b));
    const uint32_t bits = (bitsA & mask) | (bitsB & ~mask);
    float result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
}

OSGRAYTRACE_INLINE float select(bool condition, float a, float b)
{
    return select(maskOf(condition), a, b);
}

/// luminance() of colours in lanes.
OSGRAYTRACE_INLINE float luminanceOf(float red, float green, float blue)
{
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

/// A vector for each lane, structure of arrays.
struct Vec3Lanes
{
    FloatLanes x, y, z;
};

inline Vec3 laneOf(const Vec3Lanes& lanes, int i)
{
    return Vec3(lanes.x[i], lanes.y[i], lanes.z[i]);
}

inline void setLane(Vec3Lanes& lanes, int i, Vec3 value)
{
    lanes.x[i] = value.x;
    lanes.y[i] = value.y;
    lanes.z[i] = value.z;
}

} // namespace osgRayTrace::engine
