// SessionSeamsTest.cpp - a second thread in a ViewTracer or a Denoiser ends the program. There are
// cases in builds with assertions alone.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#if defined(OSGRAYTRACE_ASSERTS)
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/denoise/Denoiser.h"
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

TEST_CASE("a denoiser aborts when a second thread enters", "[session]")
{
    struct Stopped
    {
    };
    // The denoiser asks for surfaces before it filters.
    const auto denoise = [](bool enters)
    {
        const Workers one(1);
        ResolvedImage image;
        Denoiser denoiser;
        const auto surfaces = [&]() -> const std::vector<SurfaceSample>&
        {
            if (!enters) throw Stopped();
            std::thread([&] { denoiser.denoise(image, DenoiseKind::Off, {}, one); }).join();
            throw Stopped();
        };
        try
        {
            denoiser.denoise(image, DenoiseKind::Filter, surfaces, one);
        }
        catch (const Stopped&)
        {
        }
    };
    CHECK_FALSE(test::isAborted([&] { denoise(false); }));
    CHECK(test::isAborted([&] { denoise(true); }));
}
#endif
