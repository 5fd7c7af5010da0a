// ContextTest.cpp - what osgraytrace puts into pictures of what OSG draws, and what it says without
// OpenGL.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/ComparedPictures.h"
#include "tests/apps/Program.h"

#include "osgPlugins/exr/ExrImage.h"
#include "osgRayTrace/offscreen/FrameCapture"
#include "osgRayTrace/offscreen/OffscreenContext"

#include <osg/AnimationPath>
#include <osg/Geometry>
#include <osg/LineWidth>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgParticle/ModularEmitter>
#include <osgParticle/ParticleSystemUpdater>
#include <osgParticle/RadialShooter>
#include <osgParticle/RandomRateCounter>
#include <osgText/Text>
#include <osgViewer/Viewer>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

using Catch::Matchers::Contains;
using osgRayTrace::engine::ExrImage;
using osgRayTrace::engine::readExr;

namespace
{

constexpr int kWidth = 160, kHeight = 120;
const std::string kView = " --size 160 120 --eye 0 -10 0 --center 0 0 0 --up 0 0 1 --fovy 30 ";
const osg::Vec4 kRed(1.0f, 0.0f, 0.0f, 1.0f), kGreen(0.0f, 1.0f, 0.0f, 1.0f);

/// Returns lines of one colour, lit by nothing.
osg::ref_ptr<osg::Geometry> lines(const std::vector<osg::Vec3>& corners, const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(corners.begin(), corners.end()));
    geometry->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(
        new osg::DrawArrays(GL_LINE_STRIP, 0, static_cast<int>(corners.size())));
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setAttribute(new osg::LineWidth(5.0f));
    return geometry;
}

/// Returns an unlit grey wall in y = 0 that covers the left half of the picture.
osg::ref_ptr<osg::Geometry> wall()
{
    osg::ref_ptr<osg::Geometry> geometry = osg::createTexturedQuadGeometry(
        osg::Vec3(-4.0f, 0.0f, -4.0f), osg::X_AXIS * 4.0f, osg::Z_AXIS * 8.0f);
    const osg::Vec4 grey(0.5f, 0.5f, 0.5f, 1.0f);
    geometry->setColorArray(new osg::Vec4Array(1, &grey), osg::Array::BIND_OVERALL);
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

/// Returns a wall with a red line in front of it, a green one behind it, and text.
osg::ref_ptr<osg::Group> drawnScene()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(wall());
    group->addChild(lines({{-2.0f, -1.0f, 0.5f}, {2.0f, -1.0f, 0.5f}}, kRed));
    group->addChild(lines({{-2.0f, 1.0f, -0.5f}, {2.0f, 1.0f, 0.1f}}, kGreen));
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText("HI");
    text->setCharacterSize(1.5f);
    text->setAxisAlignment(osgText::Text::XZ_PLANE);
    text->setPosition(osg::Vec3(-1.2f, -0.5f, -2.2f));
    group->addChild(text);
    return group;
}

struct Drawn
{
    osg::ref_ptr<osg::Image> picture;
    ExrImage exr;

    osg::Vec4 color(int x, int y) const
    {
        return picture->getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    }
    float value(const char* channel, int x, int y) const
    {
        REQUIRE(exr.find(channel));
        return exr.find(channel)->values[size_t(y) * kWidth + x];
    }
};

Drawn draw(const TemporaryFolder& folder, const osg::Node& scene, const std::string& options)
{
    REQUIRE(osgDB::writeNodeFile(scene, folder / "scene.osgt"));
    const Outcome outcome =
        osgraytrace(folder, "scene.osgt" + kView + "-o x.png -o x.exr " + options);
    CAPTURE(outcome.errors);
    REQUIRE(outcome.exitCode == 0);
    Drawn drawn;
    drawn.picture = osgDB::readRefImageFile(folder / "x.png");
    REQUIRE(drawn.picture);
    REQUIRE(readExr(folder / "x.exr", drawn.exr) == "");
    return drawn;
}

/// Returns what OSG alone draws for the same view, without anti-aliasing.
osg::ref_ptr<osg::Image> drawnByOsg(osg::Node& scene)
{
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setSceneData(&scene);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(osgRayTrace::createEGLContext(kWidth, kHeight).get());
    camera->setViewport(0, 0, kWidth, kHeight);
    camera->setClearColor(osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f));
    camera->setViewMatrixAsLookAt({0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, osg::Z_AXIS);
    camera->setProjectionMatrixAsPerspective(30.0, double(kWidth) / kHeight, 1.0, 100.0);
    const osg::ref_ptr<osgRayTrace::FrameCapture> capture = new osgRayTrace::FrameCapture;
    camera->setFinalDrawCallback(capture.get());
    viewer.realize();
    viewer.frame(0.0);
    viewer.frame(0.0);
    return new osg::Image(*capture->getColorImage(), osg::CopyOp::DEEP_COPY_ALL);
}

float difference(const osg::Vec4& a, const osg::Vec4& b)
{
    return std::max({std::fabs(a.r() - b.r()), std::fabs(a.g() - b.g()), std::fabs(a.b() - b.b())});
}

/// Returns whether the pixels around one have its colour, so that no edge is near.
bool isFlat(const osg::Image& picture, int x, int y)
{
    const auto at = [&picture](int column, int row)
    { return picture.getColor(static_cast<unsigned int>(column), static_cast<unsigned int>(row)); };
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if (difference(at(x + dx, y + dy), at(x, y)) > 0.0f) return false;
    return true;
}

/// Returns red particles that rise from the origin.
osg::ref_ptr<osg::Group> fountain()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<osgParticle::ParticleSystem> system = new osgParticle::ParticleSystem;
    system->getDefaultParticleTemplate().setColorRange(osgParticle::rangev4(kRed, kRed));
    system->getDefaultParticleTemplate().setSizeRange(osgParticle::rangef(0.1f, 0.1f));
    system->getDefaultParticleTemplate().setLifeTime(100.0);
    osg::ref_ptr<osgParticle::ModularEmitter> emitter = new osgParticle::ModularEmitter;
    emitter->setParticleSystem(system);
    osg::ref_ptr<osgParticle::RandomRateCounter> counter = new osgParticle::RandomRateCounter;
    counter->setRateRange(20.0f, 40.0f);
    emitter->setCounter(counter);
    osg::ref_ptr<osgParticle::RadialShooter> shooter = new osgParticle::RadialShooter;
    shooter->setInitialSpeedRange(0.2f, 0.4f);
    emitter->setShooter(shooter);
    osg::ref_ptr<osgParticle::ParticleSystemUpdater> updater =
        new osgParticle::ParticleSystemUpdater;
    updater->addParticleSystem(system);
    group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    group->addChild(wall());
    group->addChild(emitter);
    group->addChild(updater);
    group->addChild(system);
    return group;
}

uint64_t redPixels(const Drawn& drawn)
{
    uint64_t count = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            count += drawn.color(x, y).r() > drawn.color(x, y).g() + 0.3f;
    return count;
}

} // namespace

TEST_CASE("osgraytrace in a context: lines and text are where OSG draws them", "[apps][gl]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Group> scene = drawnScene();
    const Drawn drawn = draw(folder, *scene, "--context egl --passes 16");
    const osg::ref_ptr<osg::Image> expected = drawnByOsg(*scene);
    int flat = 0, drawnFlat = 0, wrong = 0;
    for (int y = 1; y + 1 < kHeight; ++y)
        for (int x = 1; x + 1 < kWidth; ++x)
        {
            if (!isFlat(*expected, x, y)) continue;
            const osg::Vec4 color =
                expected->getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            ++flat;
            drawnFlat += color.r() == 1.0f || color.g() == 1.0f;
            wrong += difference(drawn.color(x, y), color) > 2.0f / 255.0f;
        }
    CHECK(flat > kWidth * kHeight / 2);
    CHECK(drawnFlat > 200);
    CHECK(wrong == 0);
}

TEST_CASE("osgraytrace in a context: what OSG draws is as smooth as the passes allow", "[apps][gl]")
{
    const TemporaryFolder folder;
    // A line that rises by a twentieth of its length before the background crosses rows of pixels.
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(wall());
    scene->addChild(lines({{0.2f, -1.0f, 0.0f}, {2.2f, -1.0f, 0.1f}}, kRed));
    const auto mixedPixels = [](const Drawn& drawn)
    {
        int count = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = kWidth / 2 + 8; x < kWidth; ++x)
                count += drawn.color(x, y).r() > 0.25f && drawn.color(x, y).r() < 0.95f;
        return count;
    };
    CHECK(mixedPixels(draw(folder, *scene, "--context egl --passes 1")) == 0);
    const Drawn smooth = draw(folder, *scene, "--context egl --passes 16");
    CHECK(mixedPixels(smooth) > 40);
    for (int y = 0; y < kHeight; ++y)
        for (int x = kWidth / 2 + 8; x < kWidth; ++x)
        {
            // Alpha is the covered share of the pixel, and radiance is red times that share.
            const float alpha = smooth.value("A", x, y);
            CHECK(smooth.value("R", x, y) == Approx(alpha).margin(1e-3));
            CHECK(smooth.color(x, y).r() == Approx(0.2f + 0.8f * alpha).margin(0.006));
        }
}

TEST_CASE("osgraytrace in a context: EXR files and their channels hold what OSG draws",
          "[apps][gl]")
{
    const TemporaryFolder folder;
    const Drawn drawn =
        draw(folder, *drawnScene(),
             "--context egl --passes 4 --aov depth,distance,position,normal,id,albedo,error");
    // The red line is 9 units away, in front of wall and background. 0.5 / (9 tan 15) of the upper
    // half of the picture is row 72.
    for (const int x : {60, 100})
    {
        CAPTURE(x);
        const int y = 72;
        CHECK(drawn.value("R", x, y) == 1.0f);
        CHECK(drawn.value("G", x, y) == 0.0f);
        CHECK(drawn.value("A", x, y) == 1.0f);
        CHECK(drawn.value("position.Y", x, y) == Approx(-1.0f).margin(1e-3));
        CHECK(drawn.value("position.Z", x, y) == Approx(0.5f).margin(0.03));
        const float alongX = 9.0f * (x + 0.5f - kWidth / 2) / (kHeight / 2) * std::tan(0.2617994f);
        CHECK(drawn.value("position.X", x, y) == Approx(alongX).margin(1e-3));
        const float up = drawn.value("position.Z", x, y);
        CHECK(drawn.value("distance.Z", x, y) ==
              Approx(std::sqrt(81.0f + alongX * alongX + up * up)).epsilon(1e-4));
        CHECK(drawn.value("depth.Z", x, y) > 0.0f);
        CHECK(drawn.value("depth.Z", x, y) < drawn.value("depth.Z", 60, 100));
        CHECK(drawn.value("id.I", x, y) == 0.0f);
        CHECK(drawn.value("normal.Y", x, y) == 0.0f);
        CHECK(drawn.value("albedo.R", x, y) == 0.0f);
        CHECK(drawn.value("error.R", x, y) == 0.0f);
    }
    // The wall is as it is traced.
    CHECK(drawn.value("position.Y", 60, 100) == Approx(0.0f).margin(1e-4));
    CHECK(drawn.value("id.I", 60, 100) == 1.0f);
    CHECK(drawn.value("normal.Y", 60, 100) == Approx(-1.0f));
    CHECK(drawn.value("depth.Z", 60, 100) < 1.0f);
}

TEST_CASE("osgraytrace in a context: particles have been emitted, for a seed the same ones",
          "[apps][gl]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Group> scene = fountain();
    CHECK(redPixels(draw(folder, *scene, "--passes 2")) == 0);
    CHECK(redPixels(draw(folder, *scene, "--context egl --passes 2")) > 50);
    const std::string first = contents(folder / "x.exr");
    draw(folder, *scene, "--context egl --passes 2");
    CHECK((contents(folder / "x.exr") == first));
    draw(folder, *scene, "--context egl --passes 2 --seed 7");
    CHECK((contents(folder / "x.exr") != first));
}

TEST_CASE(
    "osgraytrace in a context: the particles of a frame do not depend on the frames before it",
    "[apps][gl]")
{
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*fountain(), folder / "fountain.osgt"));
    const std::string render = "fountain.osgt" + kView + "--context egl --passes 2 ";
    REQUIRE(osgraytrace(folder, render + "--frames 0:2 --fps 0.7 -o p%d.exr").exitCode == 0);
    REQUIRE(osgraytrace(folder, render + "--at 2.857142857142857 -o at.exr").exitCode == 0);
    CHECK((contents(folder / "p2.exr") == contents(folder / "at.exr")));
    CHECK((contents(folder / "p2.exr") != contents(folder / "p1.exr")));
}

TEST_CASE("osgraytrace in a context: time stands still, as it does without one", "[apps][gl]")
{
    const TemporaryFolder folder;
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->insert(0.0, osg::AnimationPath::ControlPoint(osg::Vec3d(-1.0, 0.0, 0.0)));
    path->insert(0.1, osg::AnimationPath::ControlPoint(osg::Vec3d(1.0, 0.0, 0.0)));
    osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform;
    moved->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f)));
    moved->addUpdateCallback(new osg::AnimationPathCallback(path));
    draw(folder, *moved, "--passes 16");
    std::filesystem::rename(folder / "x.exr", folder / "still.exr");
    draw(folder, *moved, "--passes 16 --context egl");
    CHECK(differByRounding(folder / "x.exr", folder / "still.exr"));
}

TEST_CASE("osgraytrace without a context: one line and the statistics say what is left out",
          "[apps][gl]")
{
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*drawnScene(), folder / "scene.osgt"));
    const std::string run = "scene.osgt" + kView + "--passes 1 -o x.png --stats s.json ";
    const Outcome alone = osgraytrace(folder, run);
    CHECK(alone.exitCode == 0);
    CHECK_THAT(alone.output,
               Contains("\nleft out without OpenGL: primitive sets of lines (2), osgText's texts "
                        "(1); --context egl draws them\n"));
    const auto left = nlohmann::json::parse(contents(folder / "s.json"))["leftOut"];
    CHECK(left == nlohmann::json{{"not-traced.lines", 2}, {"not-traced.text", 1}});

    const Outcome drawn = osgraytrace(folder, run + "--context osmesa");
    CHECK(drawn.exitCode == 0);
    CHECK_THAT(drawn.output, !Contains("left out"));
    const auto json = nlohmann::json::parse(contents(folder / "s.json"));
    CHECK(json["drawnByOpenGL"] == left);
    CHECK(!json.contains("leftOut"));

    // Lines alone are no picture without OpenGL, and a whole one with it.
    REQUIRE(osgDB::writeNodeFile(*lines({{-1.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}}, kRed),
                                 folder / "scene.osgt"));
    const Outcome nothing = osgraytrace(folder, run);
    CHECK(nothing.exitCode == 3);
    CHECK_THAT(nothing.errors, Contains("no triangles") && Contains("primitive sets of lines (1)"));
    CHECK(osgraytrace(folder, run + "--context egl").exitCode == 0);
}

TEST_CASE("osgraytrace without a context: --points traces lines", "[apps][gl]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Group> scene = drawnScene();
    const auto redAt = [](const Drawn& drawn, int x, int y)
    { return drawn.value("R", x, y) > 0.2f && drawn.value("G", x, y) < 0.01f; };
    CHECK_FALSE(redAt(draw(folder, *scene, ""), 100, 72));
    const Drawn traced = draw(folder, *scene, "--points 0.1 --aov position,id");
    CHECK(redAt(traced, 60, 72));
    CHECK(redAt(traced, 100, 72));
    CHECK(traced.value("id.I", 100, 72) > 0.0f);
    CHECK(traced.value("position.Y", 100, 72) == Approx(-1.1f).margin(0.03));
    CHECK_THAT(osgraytrace(folder, "scene.osgt -o x.png --passes 1 --points 0.1").output,
               Contains("without OpenGL: osgText's texts (1);"));
}

TEST_CASE("osgraytrace in a context: a size that no context has ends with 3 and the reason",
          "[apps][gl]")
{
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*wall(), folder / "scene.osgt"));
    for (const char* context : {"egl", "osmesa"})
    {
        CAPTURE(context);
        const Outcome outcome = osgraytrace(
            folder, std::string("scene.osgt -o x.png --size 40000 2 --context ") + context);
        CHECK(outcome.exitCode == 3);
        CHECK_THAT(outcome.errors, Contains("context of 40000x2; --context none needs none"));
        CHECK(folder.fileNames() == std::vector<std::string>{"scene.osgt"});
    }
}
