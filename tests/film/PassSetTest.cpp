// PassSetTest.cpp - sets of passes with holes, and their texts.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/film/PassSet.h"

#include <random>
#include <set>

using namespace osgRayTrace::engine;

TEST_CASE("pass set: as a set of numbers, in whatever order they come", "[film]")
{
    std::mt19937 random(1);
    for (int round = 0; round < 100; ++round)
    {
        PassSet passes;
        std::set<int> numbers;
        for (int i = 0; i < 40; ++i)
        {
            const int pass = static_cast<int>(random() % 60);
            if (numbers.insert(pass).second) passes.add(pass);
        }
        for (int pass = 0; pass < 62; ++pass)
        {
            CHECK(passes.contains(pass) == (numbers.count(pass) > 0));
            int missing = pass;
            while (numbers.count(missing) > 0)
                ++missing;
            CHECK(passes.firstMissing(pass) == missing);
        }
        int even = 0;
        for (const int pass : numbers)
            even += pass % 2 == 0;
        CHECK(passes.count(0) == even);
        CHECK(passes.count() == static_cast<int>(numbers.size()));
        CHECK(passSetOf(passText(passes)) == passes);
    }
}

TEST_CASE("pass set: ranges join where they meet", "[film]")
{
    PassSet passes;
    passes.add({8, 12});
    passes.add({0, 4});
    CHECK(passText(passes) == "0-3,8-11");
    passes.add({4, 8});
    CHECK(passes.ranges() == std::vector<PassSet::Range>{{0, 12}});
    CHECK(passText(PassSet(1)) == "0");
    CHECK(passText(PassSet()).empty());
    CHECK(PassSet(3) == *passSetOf("0-2"));
}

TEST_CASE("pass set: common passes are found, whichever set has them first", "[film]")
{
    const PassSet a = *passSetOf("0-9,20-29"), b = *passSetOf("10-19,25,40");
    CHECK(a.firstCommon(b) == 25);
    CHECK(b.firstCommon(a) == 25);
    CHECK_FALSE(a.firstCommon(*passSetOf("10-19")));
    CHECK(a.firstCommon(PassSet(30)) == 0);
}

TEST_CASE("pass set: other texts are none", "[film]")
{
    for (const char* text :
         {"1,", ",1", "5-4", "1-3,2", "3,1", "-1", "x", "1 2", "1-", "99999999999", "0-2147483647"})
    {
        CAPTURE(text);
        CHECK_FALSE(passSetOf(text));
    }
    CHECK_FALSE(passSetOf(std::string(70000, '1')));
}
