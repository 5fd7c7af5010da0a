// SessionSeamsTest.cpp - a second thread in a ViewTracer, its ImageStages or a Denoiser ends the
// program. There are cases in builds with assertions alone.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#if defined(OSGRAYTRACE_ASSERTS)
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/denoise/Denoiser.h"
#include "osgRayTrace/session/view/ViewTracer.h"
#include "tests/ChildProcess.h"
#include "tests/session/CentredPass.h"

#include <thread>
#include <vector>

using osgRayTrace::test::isAborted;
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
    CHECK_FALSE(isAborted([&] { presented.recordPresented(); }));
    enters = true;
    CHECK(isAborted([&] { presented.recordPresented(); }));
}

TEST_CASE("image stages abort when a second thread enters", "[session]")
{
    const auto workers = std::make_shared<Workers>(1);
    RenderSession session(workers);
    engine::test::renderCentredPass(
        session, engine::test::cornellBox().build(),
        engine::test::perspectiveView({278, 278, 20}, {278, 250, 559}, {0, 1, 0}, 50.0, 16, 16));

    ImageStages* stages = nullptr;
    bool enters = false;
    // The stages ask for the time before and after they upsample.
    ImageStages upsampling(
        [&]
        {
            if (enters) std::thread([&] { stages->forgetKept(); }).join();
            return 0.0;
        });
    stages = &upsampling;
    upsampling.reset(workers);
    std::vector<uint8_t> rgba(4 * 32 * 32);
    const auto present = [&] {
        upsampling.presentUpsampled(session, 32, 32, {{}, rgba.data()}, 1.0);
    };
    CHECK_FALSE(isAborted(present));
    enters = true;
    CHECK(isAborted(present));
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
    CHECK_FALSE(isAborted([&] { denoise(false); }));
    CHECK(isAborted([&] { denoise(true); }));
}
#endif
