// ExactSums.cpp - fixed-point sums of tiles. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ExactSums.h"

#include "osgRayTrace/base/Assert.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kSmall = 0x1p11f;           ///< values below go to low parts
constexpr uint32_t kSmallBits = 0x45000000; ///< the bits of kSmall
constexpr float kLargest = 0x1p40f;         ///< values from here on are left out
constexpr int kHighShift = 28;              ///< high parts are multiples of 2^28 low ones
constexpr int64_t kLowMask = (int64_t(1) << kHighShift) - 1;

/// After so many passes the low parts, which were below 2^61 and have grown by less than 2^51 a
/// pass, are below 2^62.
constexpr int kCarryPasses = 1024;

/// Adding 1.5 * 2^52 to a number of magnitude below 2^51 rounds it to an integer, which stands in
/// the lower bits of the result: x * 2^40 is exact. The bits of 1.5 * 2^52 are added to it.
OSGRAYTRACE_INLINE uint64_t shiftedSmall(float value)
{
    const double shifted = static_cast<double>(value) * 0x1p40 + 0x1.8p52;
    uint64_t bits = 0;
    std::memcpy(&bits, &shifted, sizeof bits);
    return bits;
}
constexpr uint64_t kShift = 0x4338000000000000; ///< the bits of 1.5 * 2^52

OSGRAYTRACE_INLINE int64_t roundedSmall(float value)
{
    return static_cast<int64_t>(shiftedSmall(value) - kShift);
}

/// Values that a turn of the following loops takes, so that compilers unroll it.
constexpr std::size_t kTurn = 32;
static_assert(ExactSums::kValues % kTurn == 0);

/// Returns whether all values are small, and none is NaN: the bits of magnitudes are in the order
/// of the magnitudes, and those of NaN come after all.
OSGRAYTRACE_KERNEL
bool areSmall(const float* values)
{
    uint32_t others[kTurn] = {}; // the highest bit tells
    for (std::size_t first = 0; first < ExactSums::kValues; first += kTurn)
    {
        OSGRAYTRACE_SIMD
        for (std::size_t i = 0; i < kTurn; ++i)
        {
            uint32_t bits = 0;
            std::memcpy(&bits, &values[first + i], sizeof bits);
            others[i] |= (bits & 0x7fffffffu) + (0x80000000u - kSmallBits);
        }
    }
    uint32_t all = 0;
    for (const uint32_t other : others)
        all |= other;
    return all < 0x80000000u;
}

OSGRAYTRACE_KERNEL
void storeSmall(const float* __restrict values, uint64_t* __restrict sums)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < ExactSums::kValues; ++i)
        sums[i] = shiftedSmall(values[i]);
}

OSGRAYTRACE_KERNEL
void addSmall(const float* __restrict values, uint64_t* __restrict sums)
{
    for (std::size_t first = 0; first < ExactSums::kValues; first += kTurn)
    {
        OSGRAYTRACE_SIMD
        for (std::size_t i = 0; i < kTurn; ++i)
            sums[first + i] += shiftedSmall(values[first + i]);
    }
}

/// Returns the sum as a double, rounded once. Processors before AVX-512 cannot convert vectors of
/// such integers: the halves become the mantissas of 2^84 + 2^63 + high 2^32 and of 2^52 + low.
OSGRAYTRACE_INLINE double doubleOf(int64_t sum)
{
    const auto bits = static_cast<uint64_t>(sum);
    const uint64_t highBits = (bits >> 32) ^ 0x4530000080000000u;
    const uint64_t lowBits = (bits & 0xffffffffu) | 0x4330000000000000u;
    double high = 0.0, low = 0.0;
    std::memcpy(&high, &highBits, sizeof high);
    std::memcpy(&low, &lowBits, sizeof low);
    return (high - (0x1p84 + 0x1p63 + 0x1p52)) + low;
}

/// Returns 0 for sums in [-2^61, 2^61); the others need high parts.
OSGRAYTRACE_INLINE uint64_t excess(int64_t low)
{
    constexpr uint64_t kHalfRange = uint64_t(1) << 61;
    return (static_cast<uint64_t>(low) + kHalfRange) & ~(2 * kHalfRange - 1);
}

/// Writes the means of sums without high parts. Returns false, and nothing of use, if some need
/// them. shift: see ExactSums::_shifts.
OSGRAYTRACE_KERNEL
bool meansOfLow(const uint64_t* __restrict low, uint64_t shift, int count, float* __restrict values)
{
    uint64_t others = 0;
    const double passes = count;
    OSGRAYTRACE_SIMD_OR(others)
    for (std::size_t i = 0; i < ExactSums::kValues; ++i)
    {
        const auto sum = static_cast<int64_t>(low[i] - shift);
        others |= excess(sum);
        values[i] = static_cast<float>(doubleOf(sum) * 0x1p-40 / passes);
    }
    return others == 0;
}

OSGRAYTRACE_KERNEL
bool meansOfLow(const uint64_t* __restrict a, uint64_t shiftA, const uint64_t* __restrict b,
                uint64_t shiftB, int count, float* __restrict values)
{
    uint64_t others = 0;
    const double passes = count;
    OSGRAYTRACE_SIMD_OR(others)
    for (std::size_t i = 0; i < ExactSums::kValues; ++i)
    {
        const uint64_t first = a[i] - shiftA, second = b[i] - shiftB;
        const auto sum = static_cast<int64_t>(first + second);
        others |= excess(static_cast<int64_t>(first)) | excess(static_cast<int64_t>(second)) |
                  excess(sum);
        values[i] = static_cast<float>(doubleOf(sum) * 0x1p-40 / passes);
    }
    return others == 0;
}

/// Adds a value of magnitude from kSmall to kLargest, which is a multiple of 2^-12 as all such
/// floats are. Returns false where the sum would have no place.
bool addLarge(float value, int64_t& sum)
{
    constexpr int64_t kMost = int64_t(1) << 62;
    const auto units = static_cast<int64_t>(value * 0x1p12f);
    if (sum + units >= kMost || sum + units <= -kMost) return false;
    sum += units;
    return true;
}

/// Returns the sum with the members that equal sums have.
ExactSum normalised(int64_t low, int64_t high)
{
    constexpr int64_t kMostHigh = int64_t(1) << (61 - kHighShift);
    high += low >> kHighShift;
    low &= kLowMask;
    if (high < -kMostHigh || high >= kMostHigh) return {low, high};
    return {high * (int64_t(1) << kHighShift) + low, 0};
}

} // namespace

ExactSum added(const ExactSum& a, const ExactSum& b)
{
    return normalised(a.low + b.low, a.high + b.high);
}

ExactSums::ExactSums(std::size_t tiles)
    : _low(tiles * 2 * kValues), _shifts(tiles * 2, 0), _high(tiles * 2)
{
}

int ExactSums::add(std::size_t tile, int half, int passes, const RgbaLanes* values)
{
    const float* floats = values[0].r.v;
    uint64_t* sums = low(tile, half);
    uint64_t& shift = _shifts[index(tile, half)];
    if (passes == 0) _high[index(tile, half)].clear(); // of the image before
    if (passes == 0) shift = 0;
    if (passes > 0 && passes % kCarryPasses == 0) carry(tile, half);
    if (areSmall(floats))
    {
        shift += kShift;
        passes > 0 ? addSmall(floats, sums) : storeSmall(floats, sums);
        return 0;
    }
    if (passes == 0) std::fill_n(sums, kValues, uint64_t(0));
    int leftOut = 0;
    for (std::size_t i = 0; i < kValues; ++i)
    {
        if (std::fabs(floats[i]) < kSmall)
            sums[i] += static_cast<uint64_t>(roundedSmall(floats[i]));
        else if (!(std::fabs(floats[i]) < kLargest) || !addLarge(floats[i], largeOf(tile, half)[i]))
            ++leftOut;
    }
    return leftOut;
}

std::vector<int64_t>& ExactSums::largeOf(std::size_t tile, int half)
{
    std::vector<int64_t>& large = _high[index(tile, half)];
    if (large.empty()) large.assign(kValues, 0);
    return large;
}

/// Takes what is too large for the low parts over into the high ones.
void ExactSums::carry(std::size_t tile, int half)
{
    for (std::size_t i = 0; i < kValues; ++i)
        set(tile, half, i, sum(tile, half, i));
}

void ExactSums::means(std::size_t tile, int half, int count, float* values) const
{
    const std::size_t at = index(tile, half);
    if (_high[at].empty() && meansOfLow(&_low[at * kValues], _shifts[at], count, values)) return;
    for (std::size_t i = 0; i < kValues; ++i)
        values[i] = meanOf(sum(tile, half, i), count);
}

void ExactSums::means(std::size_t tile, int count, float* values) const
{
    const std::size_t first = index(tile, 0), second = index(tile, 1);
    const bool low = _high[first].empty() && _high[second].empty();
    if (low && meansOfLow(&_low[first * kValues], _shifts[first], &_low[second * kValues],
                          _shifts[second], count, values))
        return;
    for (std::size_t i = 0; i < kValues; ++i)
        values[i] = meanOf(added(sum(tile, 0, i), sum(tile, 1, i)), count);
}

ExactSum ExactSums::sum(std::size_t tile, int half, std::size_t i) const
{
    OSGRAYTRACE_ASSERT(i < kValues);
    const std::size_t at = index(tile, half);
    const std::vector<int64_t>& large = _high[at];
    return normalised(static_cast<int64_t>(_low[at * kValues + i] - _shifts[at]),
                      large.empty() ? 0 : large[i]);
}

void ExactSums::set(std::size_t tile, int half, std::size_t i, const ExactSum& sum)
{
    OSGRAYTRACE_ASSERT(i < kValues);
    low(tile, half)[i] = static_cast<uint64_t>(sum.low) + _shifts[index(tile, half)];
    if (sum.high != 0 || !_high[index(tile, half)].empty()) largeOf(tile, half)[i] = sum.high;
}

} // namespace osgRayTrace::engine
