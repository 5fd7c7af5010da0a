// OidnViewTest.cpp - views that are presented through Open Image Denoise, for which StandIn.h
// stands.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/oidn/StandIn.h"

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 32;

/// Views the Cornell box without OpenGL.
struct Screen
{
    Screen()
    {
        inputs.options.integrator = IntegratorKind::Path;
        inputs.maxPasses = 1;
        inputs.scene = cornellBox().build();
        inputs.workers = std::make_shared<Workers>(1);
        inputs.photons = std::make_shared<PhotonPasses>();
    }

    /// Returns the picture of the display, whether it is new or not.
    std::vector<uint8_t> frame(DenoiseKind denoise, const View& view)
    {
        inputs.denoise = denoise;
        tracer.trace(inputs, view);
        if (!tracer.needsResolve(inputs)) return shown;
        shown.resize(4 * kSize * kSize);
        std::vector<float> depth(kSize * kSize);
        tracer.resolve(shown.data(), depth.data());
        return shown;
    }

    ViewInputs inputs;
    ViewTracer tracer;
    std::vector<uint8_t> shown;
};

} // namespace

TEST_CASE("oidn: a view goes from one denoiser to the other without tracing anew", "[bridge][oidn]")
{
    StandIn& library = beginStandIn();
    Screen screen;
    const View view = cornellView(kSize, kSize);
    const auto plain = screen.frame(DenoiseKind::Off, view);
    CHECK(screen.tracer.progress().stages.denoised.by == DenoiseKind::Off);
    const auto filtered = screen.frame(DenoiseKind::Filter, view);
    CHECK(screen.tracer.progress().stages.denoised.by == DenoiseKind::Filter);
    CHECK(library.calls.empty());
    const auto mean = screen.frame(DenoiseKind::Oidn, view);
    CHECK(screen.tracer.progress().stages.denoised.by == DenoiseKind::Oidn);
    CHECK(screen.tracer.progress().stages.denoiseSeconds > 0.0);
    CHECK(library.times("execute") == 1);
    CHECK(plain != filtered);
    CHECK(plain != mean);
    CHECK(filtered != mean);
    CHECK(screen.frame(DenoiseKind::Oidn, view) == mean); // the frame has nothing new to do
    CHECK(library.times("execute") == 1);
    CHECK(screen.frame(DenoiseKind::Off, view) == plain);
    CHECK(screen.frame(DenoiseKind::Filter, view) == filtered);
    CHECK(screen.tracer.progress().rays.camera == uint64_t(kSize * kSize));

    // Another view has other surfaces, and the same network.
    const std::vector<float> normals = library.normal;
    const View other =
        perspectiveView({278, 273, -600}, {200, 273, 0}, {0, 1, 0}, 40.0, kSize, kSize);
    screen.frame(DenoiseKind::Oidn, other);
    CHECK(library.times("execute") == 2);
    CHECK(library.times("filter 32x32 cleanAux hdr") == 1);
    CHECK(library.normal != normals);
    CHECK(library.mistakes == std::vector<std::string>{});
}

TEST_CASE("oidn: a view is shown through the filter if the library fails", "[bridge][oidn]")
{
    Screen screen;
    const View view = cornellView(kSize, kSize);
    const auto filtered = screen.frame(DenoiseKind::Filter, view);
    beginStandIn(Fault::Execute);
    CHECK(screen.frame(DenoiseKind::Oidn, view) == filtered);
    CHECK(screen.tracer.progress().stages.denoised.by == DenoiseKind::Filter);
    CHECK(screen.tracer.progress().stages.denoised.note.find("out of luck") != std::string::npos);
    CHECK(screen.tracer.progress().status.ok());
}
