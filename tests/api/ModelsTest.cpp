// ModelsTest.cpp - real models are converted and traced by each integrator; OSG_FILE_PATH leads to
// the sample data. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/Renderer>

#include <osg/Image>
#include <osgDB/ReadFile>

#include <cmath>
#include <string>

using namespace osgRayTrace;

TEST_CASE("models: each is converted and traced, without a sample that is not finite", "[osg-data]")
{
    // Two models are left out: SmokeBox.osgt, which is nothing but particles, and morphing.osg, of
    // whose vertices OSG 3.6 reads only the first.
    const std::string name =
        GENERATE("axes.osgt", "cessna.osgt", "cessnafire.osgt", "clock.osgt", "cow.osgt",
                 "cube_mapped_torus.osgt", "dot3_bumpmapping.osgt", "dumptruck.osgt", "glider.osgt",
                 "glsl_simple.osgt", "lz.osgt", "nathan.osg", "simpleroom.osgt");
    CAPTURE(name);
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(name);
    if (!model)
    {
        WARN("skipped: " << name << " is not in OSG_FILE_PATH");
        return;
    }
    constexpr int kWidth = 64, kHeight = 48;
    for (const RayTraceSettings::Integrator integrator :
         {RayTraceSettings::WHITTED, RayTraceSettings::PATH, RayTraceSettings::PPM})
    {
        CAPTURE(static_cast<int>(integrator));
        osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
        settings->setIntegrator(integrator);
        settings->setMaxPasses(2);
        settings->setPhotons(2000);
        osg::ref_ptr<Renderer> renderer = new Renderer;
        renderer->setScene(model);
        renderer->setSettings(settings);
        renderer->setSize(kWidth, kHeight);
        renderer->setHomeView();
        REQUIRE(renderer->render());
        const Statistics& statistics = renderer->getStatistics();
        CHECK(statistics.passes == 2);
        CHECK(statistics.triangles > 0);
        CHECK(statistics.droppedSamples == 0);

        const osg::ref_ptr<osg::Image> image = renderer->getColorImage();
        REQUIRE((image->s() == kWidth && image->t() == kHeight));
        int seen = 0, lit = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
            {
                const osg::Vec4 color = image->getColor(x, y);
                REQUIRE(std::isfinite(color.r() + color.g() + color.b() + color.a()));
                seen += color.a() > 0.0f;
                lit += color.r() + color.g() + color.b() > 0.0f;
            }
        CHECK(seen > 0);
        CHECK(lit > 0);
    }
}
