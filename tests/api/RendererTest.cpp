// RendererTest.cpp - tests of the renderer that needs no graphics context: images, statistics, and
// what restarts them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

TEST_CASE("renderer: without a scene nothing is rendered", "[api][renderer]")
{
    const osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setSize(8, 8);
    CHECK_FALSE(renderer->render());
    CHECK_FALSE(renderer->getStatistics().ok);
    CHECK_FALSE(renderer->getStatistics().message.empty());
    CHECK_FALSE(renderer->getColorImage());
    CHECK_FALSE(renderer->getDisplayImage());
    CHECK_FALSE(renderer->getChannelImage("depth"));
    REQUIRE(renderer->getSettings());
    renderer->setSettings(nullptr);
    CHECK(renderer->getSettings());
    renderer->cancel();
}

TEST_CASE("renderer: sizes and matrices that cannot be are refused", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    const int big = 1 << 15;
    for (const auto& [width, height] :
         {std::pair{0, 4}, {4, 0}, {-4, 4}, {-1, -1}, {big, big}, {INT32_MAX, INT32_MAX}})
    {
        INFO(width << " x " << height);
        renderer->setSize(width, height);
        CHECK_FALSE(renderer->render());
        CHECK_FALSE(renderer->getStatistics().message.empty());
        CHECK_FALSE(renderer->getColorImage());
    }
    renderer->setSize(8, 8);
    CHECK(renderer->render());
    const auto before = renderer->getColorImage();

    renderer->setViewMatrix(osg::Matrix::scale(1.0, 1.0, 0.0));
    CHECK_FALSE(renderer->render());
    renderer->setViewMatrix(osg::Matrix::scale(1.0, std::numeric_limits<double>::quiet_NaN(), 1.0));
    CHECK_FALSE(renderer->render());
    renderer->setViewMatrix(osg::Matrix());
    renderer->setProjectionMatrix(osg::Matrix::scale(0.0, 0.0, 0.0));
    CHECK_FALSE(renderer->render());
    CHECK_FALSE(renderer->getStatistics().message.empty());
    CHECK(sameBytes(before, renderer->getColorImage())); // the last good image stays
}

TEST_CASE("renderer: an empty scene shows exactly the clear colour",
          "[api][renderer][stability 21]")
{
    const auto renderer = rendererOf(new osg::Group);
    for (const auto rule : {RayTraceSettings::DISPLAY_REFERRED, RayTraceSettings::LINEAR})
    {
        renderer->getSettings()->setColorRule(rule);
        for (const osg::Vec4& color :
             {osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f), osg::Vec4(0.0f, 1.0f, 0.7f, 1.0f)})
        {
            renderer->setClearColor(color);
            REQUIRE(renderer->render());
            CHECK(renderer->getStatistics().triangles == 0);
            const auto image = renderer->getDisplayImage();
            REQUIRE(image);
            for (int y = 0; y < image->t(); ++y)
            {
                for (int x = 0; x < image->s(); ++x)
                {
                    for (int i = 0; i < 4; ++i)
                        REQUIRE(int(image->data(x, y)[i]) == int(std::lround(255.0f * color[i])));
                }
            }
            const auto depth = renderer->getChannelImage("depth");
            REQUIRE(depth);
            CHECK(floats(*depth)[0] == 1.0f);
        }
    }
}

TEST_CASE("renderer: images have the documented formats", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    REQUIRE(renderer->render());

    const auto color = renderer->getColorImage();
    REQUIRE(color);
    CHECK(color->s() == 48);
    CHECK(color->t() == 32);
    CHECK(color->getPixelFormat() == GLenum(GL_RGBA));
    CHECK(color->getDataType() == GLenum(GL_FLOAT));
    const auto display = renderer->getDisplayImage();
    REQUIRE(display);
    CHECK(display->getPixelFormat() == GLenum(GL_RGBA));
    CHECK(display->getDataType() == GLenum(GL_UNSIGNED_BYTE));
    for (const char* name : {"depth", "distance", "id"})
    {
        INFO(name);
        const auto image = renderer->getChannelImage(name);
        REQUIRE(image);
        CHECK(image->getPixelFormat() == GLenum(GL_LUMINANCE));
        CHECK(image->getDataType() == GLenum(GL_FLOAT));
    }
    for (const char* name : {"normal", "albedo", "position", "error"})
    {
        INFO(name);
        const auto image = renderer->getChannelImage(name);
        REQUIRE(image);
        CHECK(image->getPixelFormat() == GLenum(GL_RGB));
        CHECK(image->getTotalSizeInBytes() == 48u * 32u * 12u);
    }
    CHECK_FALSE(renderer->getChannelImage("heat"));
    CHECK_FALSE(renderer->getChannelImage(""));
}

TEST_CASE("renderer: channels show the floor where it is, from the bottom row up",
          "[api][renderer]")
{
    const auto renderer =
        rendererOf(quad(osg::Vec3(-50.0f, -50.0f, 0.0f), osg::Vec3(100.0f, 0.0f, 0.0f),
                        osg::Vec3(0.0f, 100.0f, 0.0f)));
    REQUIRE(renderer->render());
    const auto position = renderer->getChannelImage("position");
    const auto normal = renderer->getChannelImage("normal");
    const auto distance = renderer->getChannelImage("distance");
    REQUIRE((position && normal && distance));
    const float* p = reinterpret_cast<const float*>(position->data(24, 2));
    CHECK(p[2] == Approx(0.0f).margin(1e-4));
    CHECK(p[1] < 0.0f); // the lower half of the picture is nearer than the centre
    const float* n = reinterpret_cast<const float*>(normal->data(24, 2));
    CHECK(n[2] == Approx(1.0f));
    const float d = *reinterpret_cast<const float*>(distance->data(24, 2));
    CHECK(d > 1.0f);
    CHECK(d < 6.0f);
}

TEST_CASE("renderer: statistics tell what was done", "[api][renderer]")
{
    const auto renderer = rendererOf(room());
    int calls = 0;
    REQUIRE(renderer->render(0.0, 0.0,
                             [&calls](const Statistics& statistics)
                             {
                                 ++calls;
                                 CHECK(statistics.passes == calls);
                                 return true;
                             }));
    CHECK(calls == 4);
    const Statistics& statistics = renderer->getStatistics();
    CHECK(statistics.ok);
    CHECK(statistics.message.empty());
    CHECK(statistics.triangles == 6);
    CHECK(statistics.lights >= 1);
    CHECK(statistics.integrator == "path");
    CHECK(statistics.passes == 4);
    CHECK(statistics.cameraRays >= 4u * 48u * 32u);
    CHECK(statistics.shadowRays > 0);
    CHECK(statistics.droppedSamples == 0);
    CHECK(std::isfinite(statistics.relativeError));
    CHECK(statistics.renderSeconds > 0.0);
}

TEST_CASE("renderer: two at once give the images that each gives alone", "[api][renderer]")
{
    const auto scene = room(); // shared by both
    const auto alone = rendererOf(scene);
    REQUIRE(alone->render());

    const auto other = room();
    other->addChild(quad(osg::Vec3(0.0f, 0.0f, 0.5f), osg::Vec3(1.0f, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 1.0f, 0.0f)));
    const auto otherAlone = rendererOf(other);
    REQUIRE(otherAlone->render());
    CHECK_FALSE(sameBytes(alone->getColorImage(), otherAlone->getColorImage()));

    osg::ref_ptr<Renderer> together[] = {rendererOf(scene), rendererOf(scene), rendererOf(other)};
    bool ok[] = {false, false, false};
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i)
    {
        threads.emplace_back([&, i] { ok[i] = together[i]->render(); });
    }
    for (std::thread& thread : threads)
    {
        thread.join();
    }
    CHECK((ok[0] && ok[1] && ok[2]));
    CHECK(sameBytes(together[0]->getColorImage(), alone->getColorImage()));
    CHECK(sameBytes(together[1]->getColorImage(), alone->getColorImage()));
    CHECK(sameBytes(together[2]->getColorImage(), otherAlone->getColorImage()));
}

TEST_CASE("renderer: the number of threads does not show", "[api][renderer]")
{
    const auto scene = room();
    const auto two = rendererOf(scene);
    REQUIRE(two->render());
    const auto one = rendererOf(scene);
    one->getSettings()->setThreads(1);
    REQUIRE(one->render());
    CHECK(sameBytes(one->getColorImage(), two->getColorImage()));

    one->getSettings()->setThreads(2); // of the same renderer
    REQUIRE(one->render());
    CHECK(one->getStatistics().passes == 4);
    CHECK(sameBytes(one->getColorImage(), two->getColorImage()));
}

TEST_CASE("renderer: passes add up until something changes", "[api][renderer]")
{
    const auto scene = room();
    const auto renderer = rendererOf(scene);
    const auto straight = rendererOf(scene);
    renderer->getSettings()->setMaxPasses(2);
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().passes == 2);
    renderer->getSettings()->setMaxPasses(4);
    const uint64_t raysBefore = renderer->getStatistics().cameraRays;
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().passes == 4);
    CHECK(renderer->getStatistics().cameraRays == 2 * raysBefore);
    REQUIRE(straight->render());
    CHECK(sameBytes(renderer->getColorImage(), straight->getColorImage()));

    const auto first = renderer->getColorImage();
    renderer->getSettings()->setSeed(5);
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().passes == 4);
    CHECK_FALSE(sameBytes(renderer->getColorImage(), first));
    renderer->getSettings()->setSeed(0);
    REQUIRE(renderer->render());
    CHECK(sameBytes(renderer->getColorImage(), first));

    renderer->getSettings()->setExposure(1.0f); // of the display only
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().cameraRays == 2 * raysBefore);
    CHECK(sameBytes(renderer->getColorImage(), first));
}

TEST_CASE("renderer: a changed graph shows once it is reported", "[api][renderer]")
{
    const auto scene = room();
    const auto renderer = rendererOf(scene);
    REQUIRE(renderer->render());
    const auto before = renderer->getColorImage();

    scene->removeChild(1u);
    REQUIRE(renderer->render());
    CHECK(sameBytes(renderer->getColorImage(), before));
    renderer->dirtyScene();
    REQUIRE(renderer->render());
    CHECK_FALSE(sameBytes(renderer->getColorImage(), before));
    CHECK(renderer->getStatistics().triangles == 4);

    renderer->setScene(room());
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().triangles == 6);
    CHECK(sameBytes(renderer->getColorImage(), before));
}

TEST_CASE("renderer: what was rendered before does not show", "[api][renderer]")
{
    const auto scene = room();
    const auto straight = rendererOf(scene);
    REQUIRE(straight->render());

    const auto travelled = rendererOf(scene);
    travelled->setViewMatrix(
        osg::Matrix::lookAt(osg::Vec3d(50.0, 3.0, 9.0), osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0)));
    REQUIRE(travelled->render());
    travelled->setViewMatrix(osg::Matrix::lookAt(
        osg::Vec3d(0.0, -6.0, 3.0), osg::Vec3d(0.0, 0.0, 0.5), osg::Vec3d(0.0, 0.0, 1.0)));
    REQUIRE(travelled->render());
    CHECK(sameBytes(travelled->getColorImage(), straight->getColorImage()));
}

TEST_CASE("renderer: ids have the node paths of what is seen", "[api][renderer]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    scene->setName("room");
    scene->getChild(1)->setName("roof");
    const auto renderer = rendererOf(scene);
    CHECK(renderer->getIdPaths().empty());
    REQUIRE(renderer->render());
    const std::vector<std::string> paths = renderer->getIdPaths();
    const auto ids = renderer->getChannelImage("id"),
               position = renderer->getChannelImage("position");
    REQUIRE(paths.size() > 1);
    CHECK(paths[0].empty());
    int roof = 0, floor = 0;
    for (int pixel = 0; pixel < ids->s() * ids->t(); ++pixel)
    {
        const auto id = static_cast<std::size_t>(floats(*ids)[pixel]);
        REQUIRE(id < paths.size());
        const float height = floats(*position)[3 * pixel + 2];
        if (id > 0 && std::abs(height - 1.0f) < 1e-3f && ++roof)
            CHECK(paths[id] == "room/roof/Geometry");
        if (id > 0 && std::abs(height) < 1e-3f && ++floor)
            CHECK(paths[id] == "room/Geode/Geometry");
    }
    CHECK((roof > 0 && floor > 0));

    renderer->dirtyScene();
    CHECK(renderer->getIdPaths().empty());
}
