// PassSumsTest.cpp - programs make parts of a picture, join them and go on from them.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/PassSums>

#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"

#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using Catch::Matchers::Contains;

namespace
{

PassSums part(int first, int end)
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = rendererOf(scene.get());
    renderer->setFirstPass(first);
    renderer->getSettings()->setMaxPasses(end);
    REQUIRE(renderer->render());
    return renderer->getPassSums();
}

} // namespace

TEST_CASE("pass sums: joined parts have the images of a renderer that makes all", "[api]")
{
    PassSums sums = part(2, 4);
    CHECK(sums.passes == "2-3");
    CHECK(sums.add(part(0, 2)) == "");
    CHECK(sums.passes == "0-3");
    CHECK(sums.passCount() == 4);

    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = rendererOf(scene.get());
    REQUIRE(renderer->render());
    CHECK(sameBytes(sums.getColorImage().get(), renderer->getColorImage().get()));
    CHECK(sameBytes(sums.getDisplayImage(0.0f, osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f)).get(),
                    renderer->getDisplayImage().get()));
    renderer->getSettings()->setExposure(1.5f);
    CHECK(sameBytes(sums.getDisplayImage(1.5f, osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f)).get(),
                    renderer->getDisplayImage().get()));
}

TEST_CASE("pass sums: a renderer goes on from those of its picture, and from no others", "[api]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = rendererOf(scene.get());
    renderer->setPassSums(part(1, 3));
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().passes == 4);
    const PassSums whole = part(0, 4), sums = renderer->getPassSums();
    CHECK(sums.low == whole.low);
    CHECK(sums.picture == whole.picture);

    renderer->getSettings()->setSeed(7);
    CHECK(renderer->getPassSums().picture == whole.picture); // of the last render
    renderer->setPassSums(whole);
    CHECK_FALSE(renderer->render());
    CHECK_THAT(renderer->getStatistics().message, Contains("seed 0, and seed 7"));
    CHECK(renderer->getPassSums().picture == whole.picture);
    REQUIRE(renderer->render()); // without these sums
    CHECK(renderer->getStatistics().passes == 4);

    scene->addChild(quad(osg::Vec3(0.0f, 0.0f, 0.2f), osg::Vec3(1.0f, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 1.0f, 0.0f)));
    renderer->dirtyScene();
    renderer->setPassSums(sums);
    renderer->getSettings()->setSeed(0);
    CHECK_FALSE(renderer->render());
    CHECK_THAT(renderer->getStatistics().message, Contains("scene "));
}

TEST_CASE("pass sums: a program tells a renderer which passes to make", "[api]")
{
    // What photons depend on is learnt from the first 16 passes, whoever makes them.
    for (const auto integrator : {RayTraceSettings::PATH, RayTraceSettings::SPPM})
    {
        CAPTURE(integrator);
        const osg::ref_ptr<osg::Group> scene = room();
        const auto rendererOfPasses = [&](int first, int end)
        {
            const auto renderer = rendererOf(scene.get());
            renderer->getSettings()->setIntegrator(integrator);
            renderer->getSettings()->setPhotons(2000);
            renderer->setFirstPass(first);
            renderer->getSettings()->setMaxPasses(end);
            return renderer;
        };
        const auto sumsOf = [&](int first, int end)
        {
            const auto renderer = rendererOfPasses(first, end);
            REQUIRE(renderer->render());
            return renderer->getPassSums();
        };
        PassSums joined = sumsOf(2, 4);
        REQUIRE(joined.add(sumsOf(20, 21)) == "");

        const auto renderer = rendererOfPasses(0, 1); // neither is looked at
        CHECK(renderer->getPictureText() == "");
        std::vector<int> passes{2, 3, 20, -1};
        std::vector<std::string> before;
        renderer->setPassSource(
            [&]
            {
                before.push_back(renderer->getPassSums().passes);
                CHECK(renderer->getPictureText() == joined.picture);
                const int pass = passes.front();
                passes.erase(passes.begin());
                return pass;
            });
        REQUIRE(renderer->render());
        CHECK(passes.empty());
        CHECK(before == std::vector<std::string>{"", "2", "2-3", "2-3,20"});
        const PassSums sums = renderer->getPassSums();
        CHECK(sums.passes == joined.passes);
        CHECK((sums.low == joined.low && sums.high == joined.high && sums.depth == joined.depth));
    }
}

TEST_CASE("pass sums: what cannot be joined stays as it was, and the reason is told", "[api]")
{
    const PassSums whole = part(0, 2);
    PassSums sums = whole;
    CHECK_THAT(sums.add(part(1, 3)), Contains("both have pass 1"));
    PassSums damaged = part(2, 3);
    damaged.low.pop_back();
    CHECK_THAT(sums.add(damaged), Contains("damaged"));
    damaged = part(2, 3);
    damaged.low[3] = std::numeric_limits<std::int64_t>::max();
    CHECK_THAT(sums.add(damaged), Contains("damaged"));
    damaged = part(2, 3);
    damaged.passes = "2-1";
    CHECK_THAT(sums.add(damaged), Contains("damaged"));
    CHECK(damaged.passCount() == 0);
    CHECK_FALSE(damaged.getColorImage());
    damaged = part(2, 3);
    damaged.width = 47;
    CHECK_THAT(sums.add(damaged), Contains("sizes"));
    CHECK(sums.low == whole.low);
    CHECK(sums.passes == whole.passes);
}

TEST_CASE("pass sums: there are none before a render, and none of a cut one", "[api]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = rendererOf(scene.get());
    CHECK(renderer->getPassSums().passes.empty());
    renderer->setWholePasses(true);
    renderer->getSettings()->setMaxPasses(1 << 20);
    REQUIRE(renderer->render(1e-6)); // ends after the first pass, which is whole
    CHECK(renderer->getStatistics().passes == 1);
    CHECK(renderer->getPassSums().passes == "0");
}

TEST_CASE("pass sums: those of a render that does not begin are not those of the next", "[api]")
{
    const osg::ref_ptr<osg::Group> scene = room();
    const auto renderer = rendererOf(scene.get());
    const osg::Matrixd projection = renderer->getProjectionMatrix();
    renderer->setProjectionMatrix(osg::Matrixd::scale(0.0, 1.0, 1.0));
    REQUIRE_FALSE(renderer->render());
    const std::string message = renderer->getStatistics().message;
    CHECK_THAT(message, Contains("cannot be inverted"));
    CHECK(renderer->getPassSums().passes.empty());

    // The sums are used up by the render that fails after they were found right.
    renderer->setProjectionMatrix(projection);
    renderer->getSettings()->setMaxPasses(2);
    REQUIRE(renderer->render());
    CHECK(renderer->getStatistics().passes == 2);
    CHECK(renderer->getPassSums().passes == "0-1");
}
