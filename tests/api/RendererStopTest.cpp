// RendererStopTest.cpp - what ends a render: cancel, progress, time and error.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"

#include <osg/observer_ptr>

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

TEST_CASE("renderer: a cancel while the scene is converted begins no pass", "[api][renderer]")
{
    // Conversions traverse nodes of classes that they do not know.
    struct CancelsInTraversal : osg::Group
    {
        void traverse(osg::NodeVisitor& visitor) override
        {
            renderer->cancel();
            ++traversals;
            osg::Group::traverse(visitor);
        }
        osg::observer_ptr<Renderer> renderer;
        int traversals = 0;
    };
    const osg::ref_ptr<CancelsInTraversal> scene = new CancelsInTraversal;
    scene->addChild(room());
    const auto renderer = rendererOf(scene.get());
    scene->renderer = renderer.get();
    CHECK_FALSE(renderer->render());
    CHECK(scene->traversals > 0);
    CHECK(renderer->getStatistics().message == "the render was cancelled");
    CHECK(renderer->getStatistics().passes == 0);
    CHECK(renderer->getStatistics().imageShare == 0.0);
    CHECK_FALSE(renderer->getColorImage());
}

// A pass of these samples takes minutes; a machine that is busy may need a while to begin it.
TEST_CASE("renderer: cancelled in its first pass, it has the tiles there are", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    renderer->setSize(640, 480);
    renderer->setViewMatrix(osg::Matrix::lookAt(osg::Vec3d(1.0, 1.0, 1.5),
                                                osg::Vec3d(1.0, 1.0, 0.0),
                                                osg::Vec3d(0.0, 1.0, 0.0))); // all floor
    renderer->setClearColor(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
    renderer->getSettings()->setIntegrator(RayTraceSettings::WHITTED);
    renderer->getSettings()->setLightSamples(4096);
    for (int milliseconds = 50; milliseconds < 20000; milliseconds *= 2)
    {
        std::thread thread([&] { CHECK_FALSE(renderer->render()); });
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        renderer->cancel();
        thread.join();
        if (renderer->getStatistics().imageShare > 0.0) break;
    }
    const double coverage = renderer->getStatistics().imageShare;
    REQUIRE(coverage > 0.0);
    CHECK(coverage < 1.0);
    CHECK(renderer->getStatistics().passes == 0);
    const auto radiance = renderer->getColorImage();
    const auto display = renderer->getDisplayImage();
    const auto depth = renderer->getChannelImage("depth");
    REQUIRE(radiance);
    REQUIRE(display);
    REQUIRE(depth);
    int covered = 0, wrong = 0;
    for (int i = 0; i < 640 * 480; ++i)
    {
        const bool hit = floats(*radiance)[4 * i + 3] > 0.0f;
        const unsigned char* shown = display->data() + 4 * i;
        covered += hit;
        if (!hit) wrong += shown[0] != 255 || shown[1] != 0 || floats(*depth)[i] != 1.0f;
    }
    CHECK(wrong == 0);
    CHECK(covered == std::lround(coverage * 640 * 480));
}

TEST_CASE("renderer: cancel from another thread ends a long render", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    renderer->setSize(640, 480);
    renderer->getSettings()->setMaxPasses(1 << 24);
    bool ok = false;
    std::thread thread([&] { ok = renderer->render(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto asked = std::chrono::steady_clock::now();
    renderer->cancel();
    thread.join();
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - asked;
    CHECK(waited.count() < 2.0); // tiles end at once; the rest is for a loaded machine
    CHECK(ok == (renderer->getStatistics().passes > 0));
    CHECK(renderer->getStatistics().passes < 1 << 24);

    renderer->setSize(8, 8);
    renderer->getSettings()->setMaxPasses(2);
    CHECK(renderer->render()); // a cancel holds for one render
    CHECK(renderer->getStatistics().passes == 2);
}

TEST_CASE("renderer: progress can stop a render, and its exceptions end there", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    CHECK(renderer->render(0.0, 0.0, [](const Statistics&) { return false; }));
    CHECK(renderer->getStatistics().passes == 1);
    CHECK_FALSE(renderer->render(
        0.0, 0.0, [](const Statistics&) -> bool { throw std::runtime_error("no"); }));
    CHECK(renderer->getStatistics().message == "no");
    CHECK_FALSE(renderer->render(0.0, 0.0, [](const Statistics&) -> bool { throw 7; }));
    CHECK(renderer->render());
    CHECK(renderer->getStatistics().passes == 4);
}

TEST_CASE("renderer: time and error stop it too", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    renderer->getSettings()->setMaxPasses(1 << 24);
    const auto begin = std::chrono::steady_clock::now();
    REQUIRE(renderer->render(0.2));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    CHECK(taken.count() > 0.15);
    CHECK(taken.count() < 10.0); // conversion and a pass beside it, on a loaded machine

    renderer->getSettings()->setSeed(1);
    REQUIRE(renderer->render(30.0, 0.05));
    CHECK(renderer->getStatistics().relativeError <= 0.05);
    CHECK(renderer->getStatistics().passes >= 2);
}

TEST_CASE("renderer: time ends it within a pass, and the next one goes on there", "[api][renderer]")
{
    const auto renderer = rendererOf(room()), calm = rendererOf(room());
    for (const auto& one : {renderer, calm})
    {
        one->setSize(160, 96); // 60 tiles
        one->getSettings()->setThreads(1);
        one->getSettings()->setMaxPasses(2);
    }
    REQUIRE(renderer->render(1e-9)); // over as soon as there is a tile
    CHECK(renderer->getStatistics().passes == 0);
    CHECK(renderer->getStatistics().cameraRays == 256);
    CHECK(renderer->getStatistics().imageShare == Approx(1.0 / 60.0));

    // What has no pass yet is the background, and far away.
    const auto color = renderer->getColorImage(), depth = renderer->getChannelImage("depth");
    REQUIRE((color && depth && renderer->getDisplayImage()));
    int missing = 0, near = 0;
    for (int p = 0; p < 160 * 96; ++p)
    {
        missing += floats(*color)[4 * p + 3] == 0.0f;
        near += floats(*depth)[p] != 1.0f;
    }
    CHECK(missing >= 160 * 96 - 256);
    CHECK(near <= 256);
    renderer->getSettings()->setDenoise(
        RayTraceSettings::FILTER); // of single tiles it makes nothing
    CHECK(sameBytes(renderer->getColorImage(), color));
    renderer->getSettings()->setDenoise(RayTraceSettings::OFF);

    for (int call = 2; call <= 70; ++call)
        REQUIRE(renderer->render(1e-9));
    CHECK(renderer->getStatistics().passes == 1);
    CHECK(renderer->getStatistics().imageShare == 1.0);
    CHECK(renderer->getStatistics().cameraRays == 70 * 256);
    REQUIRE(renderer->render());
    REQUIRE(calm->render());
    CHECK(renderer->getStatistics().passes == 2);
    CHECK(sameBytes(renderer->getColorImage(), calm->getColorImage()));
}
