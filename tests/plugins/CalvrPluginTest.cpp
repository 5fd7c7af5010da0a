// CalvrPluginTest.cpp - CalVR can load its plugin, tested without a running CalVR.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <dlfcn.h>

TEST_CASE("CalVR plugin: all of its symbols are found, and the one that CalVR asks for is exported",
          "[calvr]")
{
    void* library = dlopen(OSGRAYTRACE_TEST_CALVR_PLUGIN, RTLD_NOW);
    INFO((library ? "" : dlerror()));
    REQUIRE(library);
    CHECK(dlsym(library, "createPlugin"));
}
