// SharedArrayTest.cpp - a SharedArray keeps the memory that it refers to alive.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/base/SharedArray.h"

using osgRayTrace::engine::SharedArray;

TEST_CASE("shared array: empty by default", "[base]")
{
    const SharedArray<int> array;
    CHECK(array.empty());
    CHECK(array.size() == 0);
    CHECK(array.data() == nullptr);
    CHECK(array.begin() == array.end());
}

TEST_CASE("shared array: a vector is taken over, not copied", "[base]")
{
    std::vector<int> values{1, 2, 3};
    const int* data = values.data();
    const SharedArray<int> array(std::move(values));
    CHECK(array.data() == data);
    CHECK(array.size() == 3);
    CHECK(array[2] == 3);
    CHECK(std::vector<int>(array.begin(), array.end()) == std::vector<int>{1, 2, 3});
}

TEST_CASE("shared array: copies share storage that lives as long as the last of them", "[base]")
{
    auto owner = std::make_shared<std::vector<int>>(std::vector<int>{4, 5});
    const std::weak_ptr<std::vector<int>> alive = owner;
    {
        SharedArray<int> copy;
        {
            const int* data = owner->data();
            const SharedArray<int> borrowed(data, 2, std::move(owner));
            copy = borrowed;
            CHECK(copy.data() == data);
        }
        CHECK_FALSE(alive.expired());
        CHECK(copy[1] == 5);
    }
    CHECK(alive.expired());
}
