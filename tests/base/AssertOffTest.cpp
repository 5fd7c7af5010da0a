// AssertOffTest.cpp - an assertion that is off costs nothing: its condition is never evaluated.
// SPDX-License-Identifier: MIT
#undef OSGRAYTRACE_ASSERTS
#include "osgRayTrace/base/Assert.h"

#include "tests/Catch.h"

/// No file defines this function: the program links only if nothing calls it.
bool functionWithoutDefinition(int value);

TEST_CASE("an assertion that is off does not evaluate its condition", "[base]")
{
    int evaluations = 0;
    OSGRAYTRACE_ASSERT(++evaluations == 0);
    OSGRAYTRACE_ASSERT(functionWithoutDefinition(evaluations));
    CHECK(evaluations == 0);
}
