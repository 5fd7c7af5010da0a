// VersionTest.cpp - the version that the library states.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/Version>

#include <string>

TEST_CASE("version: what CMake's project states", "[api]")
{
    CHECK(std::string(osgRayTraceGetVersion()) == PROJECT_VERSION_OF_CMAKE);
    CHECK(std::string(osgRayTraceGetLibraryName()) == "osgRayTrace Library");
}
