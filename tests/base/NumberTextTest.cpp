// NumberTextTest.cpp - numbers become the shortest text that reads as the same number.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/NumberText.h"
#include "tests/Catch.h"

#include <cmath>
#include <cstdint>
#include <limits>

using osgRayTrace::engine::numberText;
using osgRayTrace::engine::parseNumber;

TEST_CASE("number text: it is short, and reads as the same number", "[base]")
{
    CHECK(numberText(0.1) == "0.1");
    CHECK(numberText(0.1f) == "0.1"); // the float's double is 0.10000000149
    CHECK(numberText(-17) == "-17");
    CHECK(numberText(uint64_t(18446744073709551615u)) == "18446744073709551615");
    for (const double value : {1.0 / 3.0, -0.0, 1e300, 5e-324, -1.7976931348623157e308})
    {
        const std::string text = numberText(value);
        CAPTURE(text);
        REQUIRE(parseNumber<double>(text) == value);
        CHECK(std::signbit(*parseNumber<double>(text)) == std::signbit(value));
    }
    CHECK(parseNumber<double>(numberText(std::numeric_limits<double>::infinity())) ==
          std::numeric_limits<double>::infinity());
}

TEST_CASE("number text: a text is a number as a whole or not at all", "[base]")
{
    CHECK(parseNumber<int>("+5") == 5);
    CHECK(parseNumber<double>("1e3") == 1000.0);
    for (const char* text : {"", "+", "+-5", "5 ", " 5", "5x", "1,5", "99999999999"})
    {
        CAPTURE(text);
        CHECK(!parseNumber<int>(text));
    }
}
