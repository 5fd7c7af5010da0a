// ShutterTest.cpp - motion blur compared with the time that things are seen. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/api/RenderedRoom.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/MatrixTransform>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using Catch::Matchers::Contains;
using engine::test::Estimate;

namespace
{

/// A lamp of the height and width 1 that moves along x in front of a parallel view of 32 x 4
/// pixels, which shows x from 0 to 8.
struct MovingLamp
{
    MovingLamp() : lamp(new osg::MatrixTransform), renderer(new Renderer)
    {
        const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
        material->setBaseColor(osg::Vec3(0.0f, 0.0f, 0.0f));
        material->setEmission(osg::Vec3(1.0f, 1.0f, 1.0f));
        const osg::ref_ptr<osg::Geode> square = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        square->getOrCreateStateSet()->setAttribute(material);
        lamp->addChild(square);
        renderer->setScene(lamp.get());
        renderer->setSize(32, 4);
        renderer->setViewMatrix(osg::Matrix::lookAt(osg::Vec3d(0.0, 0.0, 5.0), osg::Vec3d(),
                                                    osg::Vec3d(0.0, 1.0, 0.0)));
        renderer->setProjectionMatrix(osg::Matrix::ortho(0.0, 8.0, 0.0, 1.0, 1.0, 10.0));
        renderer->getSettings()->setThreads(2);
        renderer->getSettings()->setIntegrator(RayTraceSettings::PATH);
    }

    /// Moves the lamp from 1 by so much while the shutter is open.
    void open(double way)
    {
        renderer->setShutter(
            [this, way](double moment)
            { lamp->setMatrix(osg::Matrix::translate(1.0 + way * moment, 0.0, 0.0)); });
    }

    osg::ref_ptr<osg::Group> root;
    osg::ref_ptr<osg::MatrixTransform> lamp;
    osg::ref_ptr<Renderer> renderer;
};

/// Returns which share of the time a lamp of width 1 that goes from 1 to 1 + way covers x.
double share(double x, double way)
{
    const double from = std::max(x - 2.0, 0.0), to = std::min(x - 1.0, way);
    return std::max(to - from, 0.0) / way;
}

/// Returns the green values of the second row, by pixels.
std::vector<double> row(const Renderer& renderer)
{
    const osg::ref_ptr<osg::Image> image = renderer.getColorImage();
    std::vector<double> values;
    for (int x = 0; x < 32; ++x)
        values.push_back(double(floats(*image)[4 * (32 + x) + 1]));
    return values;
}

/// Returns the room with a roof that moves, and the renderer of it.
struct MovingRoom
{
    explicit MovingRoom(double speed = 1.0)
    {
        roof->addChild(quad({-0.5f, -0.5f, 0.5f}, {1, 0, 0}, {0, 1, 0}));
        scene->addChild(roof);
        renderer = rendererOf(scene.get());
        renderer->getSettings()->setPhotons(2000);
        renderer->setShutter(
            [this, speed](double moment)
            {
                roof->setMatrix(osg::Matrix::translate(speed * moment, 0.0, 0.0));
                renderer->setViewMatrix(osg::Matrix::lookAt(osg::Vec3d(0.5 * moment, -6.0, 3.0),
                                                            osg::Vec3d(0.0, 0.0, 0.5),
                                                            osg::Vec3d(0.0, 0.0, 1.0)));
            });
    }

    osg::ref_ptr<osg::Group> scene = room();
    osg::ref_ptr<osg::MatrixTransform> roof = new osg::MatrixTransform;
    osg::ref_ptr<Renderer> renderer;
};

PassSums sumsOf(int first, int end, RayTraceSettings::Integrator integrator, int threads = 2)
{
    MovingRoom moving;
    moving.renderer->getSettings()->setIntegrator(integrator);
    moving.renderer->getSettings()->setThreads(threads);
    moving.renderer->setFirstPass(first);
    moving.renderer->getSettings()->setMaxPasses(end);
    REQUIRE(moving.renderer->render());
    return moving.renderer->getPassSums();
}

} // namespace

TEST_CASE("shutter: a pixel is lit for the share of the time that a lamp covers it", "[api]")
{
    // The mean over 16 seeds, in which each pixel's false alarm has a probability of 1e-3; they are
    // not independent.
    const double way = 3.0;
    std::vector<Estimate> pixels(32);
    for (unsigned int seed = 0; seed < 16; ++seed)
    {
        MovingLamp moving;
        moving.open(way);
        moving.renderer->getSettings()->setSeed(seed);
        moving.renderer->getSettings()->setMaxPasses(16);
        REQUIRE(moving.renderer->render());
        const std::vector<double> values = row(*moving.renderer);
        for (std::size_t x = 0; x < 32; ++x)
            pixels[x].add(values[x]);
    }
    for (std::size_t x = 0; x < 32; ++x)
    {
        CAPTURE(x, pixels[x].mean(), pixels[x].standardError());
        double expected = 0.0; // the mean over a pixel of width 1/4
        for (int i = 0; i < 64; ++i)
            expected += share((double(x) + (i + 0.5) / 64.0) / 4.0, way) / 64.0;
        CHECK(pixels[x].agrees(expected, 0.01));
    }
}

TEST_CASE("shutter: moments are spread evenly over its time", "[api]")
{
    MovingLamp moving;
    std::vector<double> moments;
    moving.renderer->setShutter([&moments](double moment) { moments.push_back(moment); });
    moving.renderer->getSettings()->setMaxPasses(32);
    REQUIRE(moving.renderer->render());
    REQUIRE(moments.size() == 3 + 32 + 1); // the ends, the passes, the first of them again
    CHECK(moments.back() == moments[3]);
    std::vector<int> cells(32); // of even passes and of odd ones
    for (std::size_t pass = 0; pass < 32; ++pass)
        ++cells[16 * (pass % 2) + static_cast<std::size_t>(16.0 * moments[3 + pass])];
    CHECK(cells == std::vector<int>(32, 1));
}

TEST_CASE("shutter: nothing that moves gives the picture of a closed one", "[api]")
{
    MovingLamp closed, open;
    closed.lamp->setMatrix(osg::Matrix::translate(1.0, 0.0, 0.0));
    open.open(0.0);
    for (MovingLamp* moving : {&closed, &open})
    {
        moving->renderer->getSettings()->setMaxPasses(4);
        REQUIRE(moving->renderer->render());
    }
    CHECK(sameBytes(closed.renderer->getColorImage().get(), open.renderer->getColorImage().get()));
}

TEST_CASE("shutter: passes are the same for any number of threads, and whoever makes them", "[api]")
{
    for (const auto integrator : {RayTraceSettings::WHITTED, RayTraceSettings::PATH,
                                  RayTraceSettings::SPPM, RayTraceSettings::PPM})
    {
        CAPTURE(integrator);
        const PassSums whole = sumsOf(0, 6, integrator);
        CHECK(sumsOf(0, 6, integrator, 1).low == whole.low);
        PassSums joined = sumsOf(3, 6, integrator);
        REQUIRE(joined.add(sumsOf(0, 3, integrator)) == "");
        CHECK(joined.low == whole.low);
        CHECK(joined.depth == whole.depth);
    }
}

TEST_CASE("shutter: every render begins a picture, and channels are those of the first pass",
          "[api]")
{
    MovingRoom moving;
    REQUIRE(moving.renderer->render());
    const osg::ref_ptr<osg::Image> color = moving.renderer->getColorImage();
    const osg::ref_ptr<osg::Image> normals = moving.renderer->getChannelImage("normal");
    REQUIRE(moving.renderer->render());
    CHECK(moving.renderer->getStatistics().passes == 4);
    CHECK(sameBytes(color.get(), moving.renderer->getColorImage().get()));
    CHECK(sameBytes(normals.get(), moving.renderer->getChannelImage("normal").get()));

    moving.renderer->getSettings()->setMaxPasses(1);
    REQUIRE(moving.renderer->render());
    CHECK(sameBytes(normals.get(), moving.renderer->getChannelImage("normal").get()));
}

TEST_CASE("shutter: passes of another movement are refused", "[api]")
{
    MovingRoom slow(1.0), fast(2.0);
    REQUIRE(slow.renderer->render());
    fast.renderer->setPassSums(slow.renderer->getPassSums());
    CHECK_FALSE(fast.renderer->render());
    CHECK_THAT(fast.renderer->getStatistics().message, Contains("shutter "));
}

TEST_CASE("shutter: what a program throws ends the render with its words", "[api]")
{
    MovingLamp moving;
    int calls = 0;
    moving.renderer->setShutter(
        [&calls](double)
        {
            if (++calls == 6) throw std::runtime_error("the scene is gone");
        });
    CHECK_FALSE(moving.renderer->render());
    CHECK_THAT(moving.renderer->getStatistics().message, Contains("the scene is gone"));
}
