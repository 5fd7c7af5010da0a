// Lanes.h - plain arrays of sixteen values, whose loops become vector code. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/base/Bits.h"
#include "osgRayTrace/base/Kernel.h"
#include "osgRayTrace/base/Math.h"

#include <cstdint>
#include <cstring>

namespace osgRayTrace::engine
{

/// Rays are traced and shaded sixteen at a time.
constexpr int kLanes = 16;

/// A set of lanes; bit i is set if lane i is in use.
using LaneMask = uint32_t;
constexpr LaneMask kAllLanes = 0xffffu;

/// Returns the lowest lane of a mask that is not empty.
OSGRAYTRACE_INLINE int firstLane(LaneMask mask)
{
    OSGRAYTRACE_ASSERT(mask != 0 && mask <= kAllLanes);
    return lowestBit(mask);
}

/// Returns how many lanes are in a mask.
OSGRAYTRACE_INLINE int countLanes(LaneMask mask)
{
    OSGRAYTRACE_ASSERT(mask <= kAllLanes);
    return countBits(mask);
}

/// The lanes of a mask in ascending order: `for (const int i : lanesIn(mask))`. LanesIn is a range
/// instead of a function that takes a lambda: GCC compiles a lambda for the oldest CPU although the
/// lambda stands in a kernel of OSGRAYTRACE_KERNEL, and a range leaves the loop its `continue`,
/// `break` and `return`.
class LanesIn
{
public:
    OSGRAYTRACE_INLINE explicit LanesIn(LaneMask mask) : _mask(mask)
    {
        OSGRAYTRACE_ASSERT(mask <= kAllLanes);
    }

    class Iterator
    {
    public:
        OSGRAYTRACE_INLINE explicit Iterator(LaneMask left) : _left(left) {}
        OSGRAYTRACE_INLINE int operator*() const { return lowestBit(_left); }
        OSGRAYTRACE_INLINE Iterator& operator++()
        {
            _left &= _left - 1;
            return *this;
        }
        OSGRAYTRACE_INLINE bool operator!=(Iterator other) const { return _left != other._left; }

    private:
        LaneMask _left;
    };

    OSGRAYTRACE_INLINE Iterator begin() const { return Iterator(_mask); }
    OSGRAYTRACE_INLINE Iterator end() const { return Iterator(0); }

private:
    LaneMask _mask;
};

OSGRAYTRACE_INLINE LanesIn lanesIn(LaneMask mask)
{
    return LanesIn(mask);
}

/// One value for each lane.
template <class T> struct alignas(64) Lanes
{
    T v[kLanes];
    T& operator[](int lane) { return v[lane]; }
    const T& operator[](int lane) const { return v[lane]; }
};

using FloatLanes = Lanes<float>;
using UintLanes = Lanes<uint32_t>;

/// Returns all bits set if the condition holds, else 0. Conditions are joined by & and | of such
/// masks: compilers do not vectorize a mix of conditions on floats and on integers.
OSGRAYTRACE_INLINE uint32_t maskOf(bool condition)
{
    return 0u - static_cast<uint32_t>(condition);
}

/// Returns maskOf(lane i is in lanes).
OSGRAYTRACE_INLINE uint32_t laneBit(LaneMask lanes, int i)
{
    return 0u - ((lanes >> i) & 1u);
}

/// Returns bit i if mask is set, else 0.
OSGRAYTRACE_INLINE LaneMask bitOfLane(uint32_t mask, int i)
{
    return mask & (1u << i);
}

/// Returns a if the mask is set, else b. There is no branch that the compiler could move the
/// computation of a or b into: a branch would keep the loop around it from being vectorized.
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

/// Returns luminance() of a colour, for loops over lanes.
OSGRAYTRACE_INLINE float luminanceOf(float red, float green, float blue)
{
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

/// A vector for loops over lanes: a GLM vector that is made in such a loop keeps the loop from
/// being vectorized. The functions keep the order of their terms, on which the last bit depends.
struct PlainVec3
{
    float x, y, z;
};

OSGRAYTRACE_INLINE PlainVec3 plainOf(Vec3 v)
{
    return {v.x, v.y, v.z};
}

OSGRAYTRACE_INLINE PlainVec3 operator+(PlainVec3 a, PlainVec3 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

OSGRAYTRACE_INLINE PlainVec3 operator-(PlainVec3 a, PlainVec3 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

OSGRAYTRACE_INLINE PlainVec3 operator-(PlainVec3 v)
{
    return {-v.x, -v.y, -v.z};
}

OSGRAYTRACE_INLINE PlainVec3 operator*(PlainVec3 v, float s)
{
    return {v.x * s, v.y * s, v.z * s};
}

/// Returns the product component by component.
OSGRAYTRACE_INLINE PlainVec3 operator*(PlainVec3 a, PlainVec3 b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

OSGRAYTRACE_INLINE float dot(PlainVec3 a, PlainVec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

OSGRAYTRACE_INLINE PlainVec3 cross(PlainVec3 a, PlainVec3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Returns base + s * v.
OSGRAYTRACE_INLINE PlainVec3 mad(PlainVec3 v, float s, PlainVec3 base)
{
    return {base.x + s * v.x, base.y + s * v.y, base.z + s * v.z};
}

OSGRAYTRACE_INLINE PlainVec3 select(uint32_t mask, PlainVec3 a, PlainVec3 b)
{
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Returns luminance() of a colour.
OSGRAYTRACE_INLINE float luminanceOf(PlainVec3 c)
{
    return luminanceOf(c.x, c.y, c.z);
}

/// A vector for each lane, as a structure of arrays.
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

OSGRAYTRACE_INLINE PlainVec3 plainOf(const Vec3Lanes& lanes, int i)
{
    return {lanes.x[i], lanes.y[i], lanes.z[i]};
}

OSGRAYTRACE_INLINE void setLane(Vec3Lanes& lanes, int i, PlainVec3 value)
{
    lanes.x[i] = value.x;
    lanes.y[i] = value.y;
    lanes.z[i] = value.z;
}

} // namespace osgRayTrace::engine
