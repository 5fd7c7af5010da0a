// ViewTracerSeamTest.cpp - a second thread in a ViewTracer ends the program. There are cases in
// builds with assertions alone.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#if defined(OSGRAYTRACE_ASSERTS)
#include "osgRayTrace/session/view/ViewTracer.h"
#include "tests/ChildProcess.h"

#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

TEST_CASE("a view tracer aborts when a second thread enters", "[session]")
{
    ViewTracer* tracer = nullptr;
    bool enters = false;
    // The tracer asks for the time while it presents.
    ViewTracer presented(
        [&]
        {
            if (enters) std::thread([&] { tracer->forgetDisplay(); }).join();
            return 0.0;
        });
    tracer = &presented;
    CHECK_FALSE(test::isAborted([&] { presented.recordPresented(); }));
    enters = true;
    CHECK(test::isAborted([&] { presented.recordPresented(); }));
}
#endif
