// RendererDenoiseTest.cpp - denoised images of the renderer, and what it says of the denoiser.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseOidn.h"
#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"
#include "tests/bridge/Messages.h"

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using osgRayTrace::engine::DenoiseOidn;
using osgRayTrace::engine::test::Messages;

TEST_CASE("renderer: denoised images are smoother, and what was accumulated stays",
          "[api][renderer][denoise]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const osg::ref_ptr<Renderer> renderer = rendererOf(scene.get());
    renderer->getSettings()->setMaxPasses(1);
    REQUIRE(renderer->render());
    const osg::ref_ptr<osg::Image> color = renderer->getColorImage(),
                                   display = renderer->getDisplayImage();
    CHECK(renderer->getStatistics().denoiseMilliseconds == 0.0);

    renderer->getSettings()->setDenoise(RayTraceSettings::FILTER);
    const osg::ref_ptr<osg::Image> filtered = renderer->getColorImage();
    CHECK_FALSE(sameBytes(renderer->getDisplayImage(), display));
    CHECK(renderer->getStatistics().denoiseMilliseconds > 0.0);
    // Differences of neighbours on the floor, below the roof, less those of the converged image.
    const auto roughness = [](const osg::Image& image)
    {
        double sum = 0.0;
        for (int y = 4; y < 12; ++y)
            for (int x = 12; x < 36; ++x)
                sum +=
                    std::abs(floats(image)[4 * (48 * y + x)] - floats(image)[4 * (48 * y + x + 1)]);
        return sum;
    };
    const osg::ref_ptr<Renderer> converged = rendererOf(scene.get());
    converged->getSettings()->setMaxPasses(256);
    REQUIRE(converged->render());
    const double own = roughness(*converged->getColorImage());
    CHECK(roughness(*filtered) - own < 0.5 * (roughness(*color) - own));

    renderer->getSettings()->setDenoise(RayTraceSettings::OFF);
    CHECK(sameBytes(renderer->getColorImage(), color));
    CHECK(sameBytes(renderer->getDisplayImage(), display));
}

TEST_CASE("renderer: denoise oidn is the filter where it is not built in, and says so once",
          "[api][renderer][denoise]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const osg::ref_ptr<Renderer> renderer = rendererOf(scene.get());
    renderer->getSettings()->setMaxPasses(1);
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().denoiser.empty());
    renderer->getSettings()->setDenoise(RayTraceSettings::FILTER);
    const osg::ref_ptr<osg::Image> filtered = renderer->getColorImage();
    CHECK(renderer->getStatistics().denoiser == "filter");
    CHECK(renderer->getStatistics().denoiseNote.empty());

    const Messages messages;
    renderer->getSettings()->setDenoise(RayTraceSettings::OIDN);
    const osg::ref_ptr<osg::Image> image = renderer->getColorImage();
    REQUIRE(renderer->getDisplayImage());
    CHECK(renderer->getStatistics().denoiseMilliseconds > 0.0);
    if (DenoiseOidn::isBuiltIn())
    {
        CHECK(renderer->getStatistics().denoiser == "oidn");
        CHECK(messages.text().empty());
        CHECK_FALSE(sameBytes(image, filtered));
        return;
    }
    CHECK(renderer->getStatistics().denoiser == "filter");
    CHECK(renderer->getStatistics().denoiseNote ==
          "denoise oidn: this build is without Open Image Denoise; denoise filter takes its place");
    CHECK(messages.timesSaid("this build is without Open Image Denoise") == 1);
    CHECK(sameBytes(image, filtered));
}
