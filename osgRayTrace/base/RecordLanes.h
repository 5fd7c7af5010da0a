// RecordLanes.h - reads a record of 64 bytes for each lane, as columns of words. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Cpu.h"
#include "osgRayTrace/base/Lanes.h"

// Elsewhere kernels have no versions for wide vectors: see Kernel.h.
#if defined(__has_builtin) && defined(__x86_64__) && defined(__ELF__) && defined(__OPTIMIZE__) &&  \
    !defined(OSGRAYTRACE_NO_CLONES)
#if __has_builtin(__builtin_shufflevector)
#define OSGRAYTRACE_SHUFFLES
#endif
#endif

namespace osgRayTrace::engine
{

constexpr std::size_t kRecordWords = 16;

#ifdef OSGRAYTRACE_SHUFFLES

/// Returns whether readWords() is faster than a gather for each word, as it is on processors with
/// vectors of sixteen floats: narrower ones shuffle these piece by piece.
inline bool readsRecordsFast()
{
    static const bool fast = std::strcmp(cpuLevel(), "x86-64-v4") == 0;
    return fast;
}

using QuadVector = float __attribute__((vector_size(16)));
using LaneVector = float __attribute__((vector_size(64)));

/// Sets rows to four words of the records of lanes k, k + 4, k + 8 and k + 12.
OSGRAYTRACE_INLINE void readRows(const float* words, const UintLanes& at, int k, LaneVector& rows)
{
    using PairVector = float __attribute__((vector_size(32)));
    QuadVector a, b, c, d;
    std::memcpy(&a, words + at[k] * kRecordWords, sizeof(a));
    std::memcpy(&b, words + at[k + 4] * kRecordWords, sizeof(b));
    std::memcpy(&c, words + at[k + 8] * kRecordWords, sizeof(c));
    std::memcpy(&d, words + at[k + 12] * kRecordWords, sizeof(d));
    const PairVector low = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    const PairVector high = __builtin_shufflevector(c, d, 0, 1, 2, 3, 4, 5, 6, 7);
    rows = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// Sets four columns to four words of a record for each lane. words: the first of them in record 0.
/// at: the lanes' records. Sixteen short loads and transposes of four by four words take half the
/// time of four gathers.
OSGRAYTRACE_INLINE void readWords(const float* words, const UintLanes& at, FloatLanes* columns)
{
    LaneVector r0, r1, r2, r3;
    readRows(words, at, 0, r0);
    readRows(words, at, 1, r1);
    readRows(words, at, 2, r2);
    readRows(words, at, 3, r3);
    // Words 0 and 1, then 2 and 3, of lanes 0 and 1, 4 and 5, and so on; then of lanes 2 and 3.
    const LaneVector a =
        __builtin_shufflevector(r0, r1, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
    const LaneVector b =
        __builtin_shufflevector(r0, r1, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
    const LaneVector c =
        __builtin_shufflevector(r2, r3, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
    const LaneVector d =
        __builtin_shufflevector(r2, r3, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
    const LaneVector w0 =
        __builtin_shufflevector(a, c, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
    const LaneVector w1 =
        __builtin_shufflevector(a, c, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    const LaneVector w2 =
        __builtin_shufflevector(b, d, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
    const LaneVector w3 =
        __builtin_shufflevector(b, d, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    std::memcpy(&columns[0], &w0, sizeof(w0));
    std::memcpy(&columns[1], &w1, sizeof(w1));
    std::memcpy(&columns[2], &w2, sizeof(w2));
    std::memcpy(&columns[3], &w3, sizeof(w3));
}

#else

inline bool readsRecordsFast()
{
    return false;
}

OSGRAYTRACE_INLINE void readWords(const float* words, const UintLanes& at, FloatLanes* columns)
{
    for (int i = 0; i < kLanes; ++i)
        for (std::size_t k = 0; k < 4; ++k)
            columns[k][i] = words[at[i] * kRecordWords + k];
}

#endif

/// Returns the bits of a word that was read as a float.
OSGRAYTRACE_INLINE uint32_t wordOf(const FloatLanes& column, int i)
{
    const float read = column[i];
    uint32_t word;
    std::memcpy(&word, &read, sizeof(word));
    return word;
}

} // namespace osgRayTrace::engine
