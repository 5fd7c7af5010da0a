// OidnViewTest.cpp - views that are presented through Open Image Denoise, for which StandIn.h
// stands.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/view/ViewTracer.h"

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
        settings->setIntegrator(RayTraceSettings::PATH);
        settings->setMaxPasses(1);
        version.scene = cornellBox().build();
        version.workers = std::make_shared<Workers>(1);
        version.photons = std::make_shared<PhotonPasses>();
    }

    /// Returns the picture of the display, whether it is new or not.
    std::vector<uint8_t> frame(RayTraceSettings::Denoise denoise, const View& view)
    {
        settings->setDenoise(denoise);
        version.settings = new RayTraceSettings(*settings);
        tracer.trace(version, view);
        if (!tracer.needsResolve(version)) return shown;
        shown.resize(4 * kSize * kSize);
        std::vector<float> depth(kSize * kSize);
        tracer.resolve(shown.data(), depth.data());
        return shown;
    }

    osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    SceneVersion version;
    ViewTracer tracer;
    std::vector<uint8_t> shown;
};

} // namespace

TEST_CASE("oidn: a view goes from one denoiser to the other without tracing anew", "[bridge][oidn]")
{
    StandIn& library = beginStandIn();
    Screen screen;
    const View view = cornellView(kSize, kSize);
    const auto plain = screen.frame(RayTraceSettings::OFF, view);
    CHECK(screen.tracer.progress().denoised.by == DenoiseKind::Off);
    const auto filtered = screen.frame(RayTraceSettings::FILTER, view);
    CHECK(screen.tracer.progress().denoised.by == DenoiseKind::Filter);
    CHECK(library.calls.empty());
    const auto mean = screen.frame(RayTraceSettings::OIDN, view);
    CHECK(screen.tracer.progress().denoised.by == DenoiseKind::Oidn);
    CHECK(screen.tracer.progress().denoiseSeconds > 0.0);
    CHECK(library.times("execute") == 1);
    CHECK(plain != filtered);
    CHECK(plain != mean);
    CHECK(filtered != mean);
    CHECK(screen.frame(RayTraceSettings::OIDN, view) == mean); // the frame has nothing new to do
    CHECK(library.times("execute") == 1);
    CHECK(screen.frame(RayTraceSettings::OFF, view) == plain);
    CHECK(screen.frame(RayTraceSettings::FILTER, view) == filtered);
    CHECK(screen.tracer.progress().rays.camera == uint64_t(kSize * kSize));

    // Another view has other surfaces, and the same network.
    const std::vector<float> normals = library.normal;
    const View other =
        perspectiveView({278, 273, -600}, {200, 273, 0}, {0, 1, 0}, 40.0, kSize, kSize);
    screen.frame(RayTraceSettings::OIDN, other);
    CHECK(library.times("execute") == 2);
    CHECK(library.times("filter 32x32 cleanAux hdr") == 1);
    CHECK(library.normal != normals);
    CHECK(library.mistakes == std::vector<std::string>{});
}

TEST_CASE("oidn: a view is shown through the filter if the library fails", "[bridge][oidn]")
{
    Screen screen;
    const View view = cornellView(kSize, kSize);
    const auto filtered = screen.frame(RayTraceSettings::FILTER, view);
    beginStandIn(Fault::Execute);
    CHECK(screen.frame(RayTraceSettings::OIDN, view) == filtered);
    CHECK(screen.tracer.progress().denoised.by == DenoiseKind::Filter);
    CHECK(screen.tracer.progress().denoised.note.find("out of luck") != std::string::npos);
    CHECK(screen.tracer.progress().status.ok());
}
