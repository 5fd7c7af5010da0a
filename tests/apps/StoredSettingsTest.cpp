// StoredSettingsTest.cpp - what a scene stores besides surfaces, and what osgraytrace says about
// pictures.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

using Catch::Matchers::Contains;
using osgRayTrace::RayTracedScene;
using osgRayTrace::RayTraceSettings;

namespace
{

const std::string kQuick = " --size 32 24 -o x.png ";

osg::ref_ptr<osg::MatrixTransform> ball(const std::string& name, float x)
{
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrix::translate(x, 0.0, 0.0));
    transform->setName(name);
    transform->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f)));
    return transform;
}

/// Returns two balls beside each other.
osg::ref_ptr<osg::Group> pair()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(ball("left", -2.0f));
    group->addChild(ball("right", 2.0f));
    return group;
}

/// Returns whether the picture is lighter than the background at column x.
bool showsBall(const std::string& file, unsigned int x)
{
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file);
    REQUIRE(picture);
    return picture->getColor(x, static_cast<unsigned int>(picture->t()) / 2).r() > 0.4f;
}

} // namespace

TEST_CASE(
    "osgraytrace: settings that come with a scene hold, unless the command line says otherwise",
    "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*pair(), folder / "pair.osgt"));
    const osg::ref_ptr<RayTracedScene> stored = new RayTracedScene;
    stored->addChild(pair());
    stored->getSettings()->setIntegrator(RayTraceSettings::PATH);
    REQUIRE(osgDB::writeNodeFile(*stored, folder / "stored.osgt"));

    CHECK_THAT(osgraytrace(folder, "pair.osgt" + kQuick).output, Contains("whitted, 64 passes"));
    for (const char* model : {"'pair.osgt.(integrator=path).raytrace'", "stored.osgt"})
    {
        CAPTURE(model);
        CHECK_THAT(osgraytrace(folder, model + kQuick).output, Contains("path, 64 passes"));
        CHECK_THAT(osgraytrace(folder, model + kQuick + "--integrator whitted --passes 2").output,
                   Contains("whitted, 2 passes"));
        CHECK_THAT(osgraytrace(folder, model + kQuick + "--passes 3").output,
                   Contains("path, 3 passes"));
    }
    const std::string passes = "'pair.osgt.(integrator=path,passes=5).raytrace'";
    CHECK_THAT(osgraytrace(folder, passes + kQuick).output, Contains("path, 5 passes"));
    CHECK_THAT(osgraytrace(folder, passes + kQuick + "--passes 2").output,
               Contains("path, 2 passes"));
    CHECK_THAT(osgraytrace(folder, passes + kQuick + "--context osmesa").output,
               Contains("path, 5 passes"));

    const Outcome wrong =
        osgraytrace(folder, "'pair.osgt.(materials=none.json).raytrace'" + kQuick);
    CHECK(wrong.exitCode == 2);
    CHECK_THAT(wrong.errors, Contains("none.json"));
}

TEST_CASE("osgraytrace: a picture that shows nothing says so, and has no error", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*pair(), folder / "pair.osgt"));
    const Outcome away =
        osgraytrace(folder, "pair.osgt --eye 0 -10 0 --center 0 -20 0 --passes 4" + kQuick);
    CHECK(away.exitCode == 0);
    CHECK_THAT(away.output,
               Contains("nothing was hit") && Contains("--eye") && !Contains("estimated error"));
    CHECK_THAT(osgraytrace(folder, "pair.osgt --passes 4" + kQuick).output,
               Contains("estimated error") && !Contains("nothing was hit"));

    // The view shows the box without its light.
    const Outcome dark =
        osgraytrace(folder, dataFile("cornell_box.osgt") +
                                " --eye -278 -200 278 --max-bounces 0 --center -278 0 100 "
                                "--passes 4" +
                                kQuick);
    CHECK_THAT(dark.output, Contains("is black") && !Contains("estimated error"));
}

TEST_CASE("osgraytrace: what is hinted to be rasterized is in every picture, or named", "[apps]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Group> group = pair();
    RayTracedScene::setHint(group->getChild(1), RayTracedScene::RASTERIZE);
    REQUIRE(osgDB::writeNodeFile(*group, folder / "hinted.osgt"));
    const std::string write = "hinted.osgt --size 32 16 --passes 4 --report -o x.png -o x.exr ";

    const Outcome alone = osgraytrace(folder, write);
    CHECK(alone.exitCode == 0);
    CHECK_THAT(alone.output, Contains("1  rasterize hint\n              Group/right/"));
    CHECK(showsBall(folder / "x.png", 12));
    CHECK(showsBall(folder / "x.png", 20));
    CHECK(!showsBall(folder / "x.png", 1));
    CHECK(showsBall(folder / "x.exr", 20));
    CHECK(!Contains("without OpenGL").match(alone.output));

    const Outcome drawn = osgraytrace(folder, write + "--context osmesa");
    CHECK(drawn.exitCode == 0);
    CHECK_THAT(drawn.output, Contains("left to OSG to draw:\n         1  hint"));
    CHECK(showsBall(folder / "x.png", 20));
    CHECK(showsBall(folder / "x.exr", 12));
    CHECK(showsBall(folder / "x.exr", 20));
    CHECK(!showsBall(folder / "x.exr", 1));

    // OSG draws the whole scene, and nothing is left to trace.
    RayTracedScene::setHint(group, RayTracedScene::RASTERIZE);
    REQUIRE(osgDB::writeNodeFile(*group, folder / "hinted.osgt"));
    const Outcome all =
        osgraytrace(folder, "hinted.osgt --size 32 16 --passes 4 -o x.png --context osmesa");
    CAPTURE(all.errors);
    CHECK(all.exitCode == 0);
    CHECK_THAT(all.output, Contains("drawn by OpenGL") && !Contains("estimated error"));
    CHECK(showsBall(folder / "x.png", 12));
    CHECK(showsBall(folder / "x.png", 20));
}

TEST_CASE("osgraytrace: an error that was asked for and not reached is said", "[apps]")
{
    const TemporaryFolder folder;
    const std::string box = dataFile("cornell_box.osgt") + kQuick;
    CHECK_THAT(osgraytrace(folder, box + "--error 0.0001 --passes 3").output,
               Contains("--error 0.01 % was not reached"));
    CHECK_THAT(osgraytrace(folder, box + "--error 0.5").output,
               Contains("estimated error") && !Contains("not reached"));
}

TEST_CASE("osgraytrace: of slides the first is shown, as in osgviewer's first frame", "[apps]")
{
    if (!osgDB::Registry::instance()->getReaderWriterForExtension("p3d"))
    {
        WARN("OpenSceneGraph has no plugin for .p3d here");
        return;
    }
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*ball("first", 0.0f), folder / "first.osgt"));
    REQUIRE(osgDB::writeNodeFile(*ball("second", 0.0f), folder / "second.osgt"));
    std::ofstream(folder / "talk.p3d")
        << "<presentation><slide><layer><model>first.osgt</model></layer>"
           "<layer><model>second.osgt</model></layer></slide>"
           "<slide><layer><model>second.osgt</model></layer></slide></presentation>";
    const Outcome outcome = osgraytrace(folder, "talk.p3d --report --size 8 8");
    CHECK(outcome.exitCode == 0);
    CHECK_THAT(outcome.output, Contains("/first/") && !Contains("/second/"));
    CHECK_THAT(outcome.output,
               Contains("         1  geometry\n") && Contains("         1  instance\n"));
}
