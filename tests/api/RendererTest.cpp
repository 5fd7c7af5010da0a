// RendererTest.cpp - tests of the renderer that needs no graphics context.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseOidn.h"
#include "tests/Catch.h"
#include "tests/bridge/Messages.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/Renderer>

#include <osg/CullFace>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/observer_ptr>

#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <thread>

using osgRayTrace::AreaLight;
using osgRayTrace::RayTraceSettings;
using osgRayTrace::Renderer;
using osgRayTrace::Statistics;
using osgRayTrace::engine::DenoiseOidn;
using osgRayTrace::engine::test::Messages;

namespace
{

osg::ref_ptr<osg::Geode> quad(const osg::Vec3& corner, const osg::Vec3& u, const osg::Vec3& v)
{
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(osg::createTexturedQuadGeometry(corner, u, v));
    geode->getOrCreateStateSet()->setAttribute(new osg::Material);
    return geode;
}

/// A floor below a smaller roof, and a lamp between them: soft shadows and noise.
osg::ref_ptr<osg::Group> room()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(quad(osg::Vec3(-2.0f, -2.0f, 0.0f), osg::Vec3(4.0f, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 4.0f, 0.0f)));
    group->addChild(quad(osg::Vec3(-1.0f, -1.0f, 1.0f), osg::Vec3(1.0f, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 1.0f, 0.0f)));
    group->addChild(new AreaLight(osg::Vec3(-0.5f, -0.5f, 2.0f), osg::Vec3(0.0f, 1.0f, 0.0f),
                                  osg::Vec3(1.0f, 0.0f, 0.0f), osg::Vec3(5.0f, 5.0f, 5.0f)));
    return group;
}

/// 48 x 32 pixels of the room from above and in front, two threads, four passes.
osg::ref_ptr<Renderer> rendererOf(osg::Node* scene)
{
    osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(scene);
    renderer->setSize(48, 32);
    renderer->setViewMatrix(osg::Matrix::lookAt(
        osg::Vec3d(0.0, -6.0, 3.0), osg::Vec3d(0.0, 0.0, 0.5), osg::Vec3d(0.0, 0.0, 1.0)));
    renderer->setProjectionMatrix(osg::Matrix::perspective(45.0, 1.5, 1.0, 100.0));
    renderer->getSettings()->setThreads(2);
    renderer->getSettings()->setMaxPasses(4);
    renderer->getSettings()->setIntegrator(RayTraceSettings::PATH);
    return renderer;
}

bool sameBytes(const osg::Image* a, const osg::Image* b)
{
    return a && b && a->getTotalSizeInBytes() == b->getTotalSizeInBytes() &&
           std::memcmp(a->data(), b->data(), a->getTotalSizeInBytes()) == 0;
}

const float* floats(const osg::Image& image)
{
    return reinterpret_cast<const float*>(image.data());
}

} // namespace

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

TEST_CASE("renderer: forty spots of their own numbers each light their own patch",
          "[api][renderer]")
{
    constexpr int kSpots = 40;
    // Two have numbers further off, and two the same, of which the later one counts.
    const auto numberOf = [](int i) { return i == 38 ? 1000 : i == 39 ? 16383 : i == 37 ? 36 : i; };
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(quad(osg::Vec3(0.0f, 0.0f, 0.0f), osg::Vec3(kSpots, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 1.0f, 0.0f)));
    for (int i = 0; i < kSpots; ++i)
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        osg::Light* light = source->getLight();
        light->setLightNum(numberOf(i));
        light->setPosition(osg::Vec4(float(i) + 0.5f, 0.5f, 1.0f, 1.0f));
        light->setDirection(osg::Vec3(0.0f, 0.0f, -1.0f));
        light->setSpotCutoff(20.0f);
        light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        light->setDiffuse(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
        source->setStateSetModes(*scene->getOrCreateStateSet(), osg::StateAttribute::ON);
        scene->addChild(source);
    }
    const auto renderer = rendererOf(scene);
    renderer->setHeadlight(false);
    renderer->setSize(4 * kSpots, 4);
    renderer->setViewMatrix(osg::Matrix::lookAt(osg::Vec3d(0.5 * kSpots, 0.5, 10.0),
                                                osg::Vec3d(0.5 * kSpots, 0.5, 0.0),
                                                osg::Vec3d(0.0, 1.0, 0.0)));
    renderer->setProjectionMatrix(
        osg::Matrix::ortho(-0.5 * kSpots, 0.5 * kSpots, -0.5, 0.5, 1.0, 20.0));
    for (const auto kind : {RayTraceSettings::WHITTED, RayTraceSettings::PATH})
    {
        renderer->getSettings()->setIntegrator(kind);
        REQUIRE(renderer->render());
        const auto image = renderer->getColorImage();
        REQUIRE(image);
        std::vector<int> dark;
        for (int i = 0; i < kSpots; ++i)
        {
            float sum = 0.0f;
            for (int y = 1; y < 3; ++y)
                for (int x = 1; x < 3; ++x)
                    sum += reinterpret_cast<const float*>(image->data(4 * i + x, y))[1];
            if (sum < 1.0f) dark.push_back(i);
        }
        CHECK(dark == std::vector<int>{36});
    }
    CHECK(renderer->getStatistics().lights == kSpots - 1);
    CHECK(renderer->getStatistics().conversion.at("unused.light-replaced") == 1);
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

TEST_CASE("renderer: culled faces cast shadows, or are there for no ray", "[api][renderer]")
{
    // A floor, above it the eye, a roof whose back is below, and a light.
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(quad(osg::Vec3(-9, -9, 0), osg::Vec3(18, 0, 0), osg::Vec3(0, 18, 0)));
    scene->addChild(quad(osg::Vec3(-9, -9, 8), osg::Vec3(18, 0, 0), osg::Vec3(0, 18, 0)));
    scene->getChild(1)->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace);
    osg::ref_ptr<osg::LightSource> sun = new osg::LightSource; // number 0, from z = infinity
    scene->addChild(sun);
    scene->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    const auto renderer = rendererOf(scene);
    renderer->setHeadlight(false);
    renderer->setViewMatrix(
        osg::Matrix::lookAt(osg::Vec3d(0, 0, 6), osg::Vec3d(), osg::Vec3d(0, 1, 0)));
    renderer->getSettings()->setIntegrator(RayTraceSettings::WHITTED);
    const auto shown = [&]
    {
        REQUIRE(renderer->render());
        return int(renderer->getDisplayImage()->data(24, 16)[0]);
    };
    const int inShadow = shown();
    renderer->getSettings()->setCullAllRays(true);
    CHECK(shown() > inShadow + 100);
    renderer->getSettings()->setCullAllRays(false);
    CHECK(shown() == inShadow);
}

TEST_CASE("renderer: the headlight is osgViewer's", "[api][renderer]")
{
    // A white wall that faces the eye: material diffuse 0.8 times light 0.8, and ambient light on
    // both.
    const auto wall = quad(osg::Vec3(-50.0f, 0.0f, -50.0f), osg::Vec3(100.0f, 0.0f, 0.0f),
                           osg::Vec3(0.0f, 0.0f, 100.0f));
    const auto renderer = rendererOf(wall);
    renderer->setViewMatrix(
        osg::Matrix::lookAt(osg::Vec3d(0.0, -5.0, 0.0), osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0)));
    renderer->getSettings()->setIntegrator(RayTraceSettings::WHITTED);
    REQUIRE(renderer->render());
    const int lit = renderer->getDisplayImage()->data(24, 16)[0];
    renderer->setHeadlight(false);
    REQUIRE(renderer->render());
    const int unlit = renderer->getDisplayImage()->data(24, 16)[0];
    CHECK(lit - unlit == Approx(0.64 * 255.0).margin(1.0));
}

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
    // Differences of neighbours on the floor, below the roof.
    const auto roughness = [](const osg::Image& image)
    {
        double sum = 0.0;
        for (int y = 4; y < 12; ++y)
            for (int x = 12; x < 36; ++x)
                sum +=
                    std::abs(floats(image)[4 * (48 * y + x)] - floats(image)[4 * (48 * y + x + 1)]);
        return sum;
    };
    CHECK(roughness(*filtered) < 0.5 * roughness(*color));

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
