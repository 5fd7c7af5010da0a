// LargeArrayTest.cpp - uncleared arrays keep their memory where the next size fits into it.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/base/LargeArray.h"

using osgRayTrace::engine::UnclearedArray;

TEST_CASE("uncleared array: memory is used again while it fits", "[base]")
{
    UnclearedArray<int> array;
    CHECK(array.capacity() == 0);
    array.reuse(10);
    CHECK(array.capacity() == 10);
    array.reuse(1600);
    const int* const data = array.data();
    CHECK(array.size() == 1600);
    CHECK(array.capacity() == 1700);

    for (const std::size_t fits : {1700, 850, 1601})
    {
        array.reuse(fits);
        CHECK(array.size() == fits);
        CHECK(array.capacity() == 1700);
        CHECK(array.data() == data);
    }

    UnclearedArray<int> moved = std::move(array);
    CHECK(array.capacity() == 0);
    CHECK(moved.capacity() == 1700);
    CHECK(moved.data() == data);
}

TEST_CASE("uncleared array: memory that is too small or more than twice too large is replaced",
          "[base]")
{
    UnclearedArray<int> array(1000);
    CHECK(array.capacity() == 1000);
    array.reuse(1001);
    CHECK(array.size() == 1001);
    CHECK(array.capacity() == 1063);
    array.reuse(500);
    CHECK(array.capacity() == 531);
    array[499] = 7;
    CHECK(array[499] == 7);
    array.reuse(0);
    CHECK(array.size() == 0);
    CHECK(array.capacity() == 0);
    CHECK(array.data() == nullptr);
}
