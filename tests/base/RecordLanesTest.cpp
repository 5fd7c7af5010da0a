// RecordLanesTest.cpp - tests of records and bounds in lanes. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/base/QuickCompare.h"
#include "osgRayTrace/base/RecordLanes.h"

#include <vector>

using namespace osgRayTrace::engine;

TEST_CASE("record lanes: each column has the same word of the lanes' records", "[base]")
{
    constexpr uint32_t kRecords = 40;
    std::vector<float> words;
    for (uint32_t k = 0; k < kRecords * kRecordWords; ++k)
        words.push_back(static_cast<float>(k));
    UintLanes at;
    for (uint32_t i = 0; i < kLanes; ++i)
        at.v[i] = (7 * i + 3) % kRecords;
    for (std::size_t first = 0; first < kRecordWords; first += 4)
    {
        FloatLanes columns[4];
        readWords(words.data() + first, at, columns);
        for (std::size_t k = 0; k < 4; ++k)
            for (int i = 0; i < kLanes; ++i)
                REQUIRE(columns[k][i] == static_cast<float>(kRecordWords * at[i] + first + k));
    }
}

TEST_CASE("quick compare: bounds and comparisons are those of floats", "[base]")
{
    const float values[] = {-kInfinity, -1e30f, -2.0f, -1e-30f, 0.0f,     1e-30f,
                            0.5f,       1.0f,   2.0f,  1e30f,   kInfinity};
    for (const float x : values)
        for (const float bound : values)
        {
            if (x == bound) continue; // infinity less itself is NaN
            CHECK((isLess(x, bound) == ~0u) == (x < bound));
            if (bound < 0.0f) continue;
            CHECK(atLeast(x, bound) == (x > bound ? x : bound));
            CHECK(atMost(x, bound) == (x < bound ? x : bound));
        }
    CHECK(isLess(1.0f, 1.0f) == 0u);
    CHECK(atLeast(-0.0f, 0.0f) == 0.0f);
    CHECK(signMask(-1.0f) == ~0u);
    CHECK(signMask(1.0f) == 0u);
}
