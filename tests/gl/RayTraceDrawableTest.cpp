// RayTraceDrawableTest.cpp - the drawable under a viewer: viewports, contexts, eyes and pictures.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "GreenScene.h"
#include "tests/Catch.h"

#include <osgRayTrace/AreaLight>

#include <osg/MatrixTransform>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

TEST_CASE("drawable: the viewport may change, start anywhere and be empty", "[gl][stability 20]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    scene->getSettings()->setMaxPasses(1);
    TestViewer view(kSize, kSize, scene.get());
    view.camera().setProjectionResizePolicy(osg::Camera::FIXED);
    const int whole = countGreen(*view.frames(2));
    CHECK(whole > 100);

    view.camera().setViewport(0, 0, 0, 0);
    view.frames(2);
    view.camera().setViewport(kSize / 2, kSize / 2, kSize / 2, kSize / 2);
    view.frames();
    CHECK(passes(*scene) == 1);
    const osg::ref_ptr<osg::Image> radiance = scene->getDrawable()->getColorImage();
    REQUIRE(radiance);
    CHECK(radiance->s() == kSize / 2);
    // The captured picture is that of the viewport.
    const int quarter = countGreen(*view.frames());
    CHECK(quarter == Approx(whole / 4.0).epsilon(0.1));

    view.camera().setViewport(0, 0, kSize, kSize);
    CHECK(countGreen(*view.frames()) == whole);
}

TEST_CASE("drawable: a scene that is seen no more leaves no image, except at pause", "[gl]")
{
    const bool inBackground = GENERATE(false, true);
    const osg::ref_ptr<RayTracedScene> scene = greenScene();
    const osg::ref_ptr<osg::Node> square = scene->getChild(0);
    const osg::ref_ptr<RayTraceDrawable> drawable = scene->getDrawable();
    scene->getSettings()->setFrameBudget(1000.0f);
    if (inBackground) scene->getSettings()->setPresentation(RayTraceSettings::BACKGROUND);
    TestViewer view(kSize, kSize, scene.get());
    const auto showGreen = [&]
    {
        int green = 0;
        for (int i = 0; i < 20000 && green == 0; ++i) // more frames than any machine needs
            green = countGreen(*view.frames());
        return green;
    };
    CHECK(showGreen() > 100);
    REQUIRE(drawable->getColorImage());
    drawable->setPaused(true);
    scene->removeChild(square);
    CHECK(countGreen(*view.frames(2)) > 100);
    CHECK(drawable->getColorImage());

    drawable->setPaused(false);
    CHECK(countGreen(*view.frames(2)) == 0);
    CHECK_FALSE(drawable->getColorImage());
    CHECK_FALSE(drawable->getChannelImage("depth"));

    const osg::ref_ptr<osg::Group> moved =
        new osg::MatrixTransform(osg::Matrix::translate(9, 0, 0));
    moved->addChild(square);
    scene->addChild(moved);
    CHECK(countGreen(*view.frames(2)) == 0); // nothing is left of the old picture
    scene->addChild(square);
    CHECK(showGreen() > 100);
}

TEST_CASE("drawable: GL objects are released and made again", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    scene->getSettings()->setMaxPasses(1);
    scene->releaseGLObjects();
    scene->resizeGLObjectBuffers(4);
    TestViewer view(kSize, kSize, scene.get());
    const osg::ref_ptr<osg::Image> first = view.frames();

    osg::State* state = view.camera().getGraphicsContext()->getState();
    scene->releaseGLObjects(state);
    scene->releaseGLObjects(state);
    CHECK(equal(*view.frames(), *first));
    scene->resizeGLObjectBuffers(8);
    scene->releaseGLObjects();
    scene->releaseGLObjects();
    CHECK(equal(*view.frames(), *first));
}

TEST_CASE("drawable: several contexts show one scene, each from its own side", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(nullptr);
    osg::ref_ptr<osg::Geometry> front = unlitSquare(1.0f, kGreen);
    osg::ref_ptr<osg::MatrixTransform> back = new osg::MatrixTransform(
        osg::Matrix::rotate(osg::PI, osg::Vec3d(0, 1, 0)) * osg::Matrix::translate(0, 0, -1));
    back->addChild(unlitSquare(1.0f, osg::Vec4(1, 0, 0, 1)));
    scene->addChild(front);
    scene->addChild(back);

    TestViewer a(kSize, kSize, scene.get());
    TestViewer b(kSize, 2 * kSize, scene.get());
    b.look(osg::Vec3d(0, 0, -10));
    for (int i = 1; i <= 3; ++i)
    {
        CHECK(pixel(*a.frames(), kMiddle, kMiddle) == kGreenPixel);
        CHECK(passes(*scene) == i);
        CHECK(pixel(*b.frames(), kMiddle, kSize) == osg::Vec4(255, 0, 0, 255));
        CHECK(passes(*scene) == i);
    }
    b.viewer.setSceneData(nullptr);
    b.camera().getGraphicsContext()->close();
    CHECK(pixel(*a.frames(), kMiddle, kMiddle) == kGreenPixel);
}

TEST_CASE("drawable: in stereo each eye keeps its own image", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    osg::ref_ptr<osg::DisplaySettings> stereo =
        new osg::DisplaySettings(*osg::DisplaySettings::instance());
    stereo->setStereo(true);
    stereo->setStereoMode(GENERATE(osg::DisplaySettings::ANAGLYPHIC,
                                   osg::DisplaySettings::HORIZONTAL_SPLIT,
                                   osg::DisplaySettings::VERTICAL_INTERLACE));
    TestViewer view(kSize, kSize, scene.get());
    view.camera().setDisplaySettings(stereo.get());
    for (int i = 1; i <= 4; ++i)
    {
        view.frames();
        CHECK(passes(*scene) == i);
    }
}

TEST_CASE("drawable: paused it keeps its picture", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    TestViewer view(kSize, kSize, scene.get());
    const osg::ref_ptr<osg::Image> before = view.frames();
    scene->getDrawable()->setPaused(true);
    view.look(osg::Vec3d(3.0, 0.0, 10.0), osg::Vec3d(3.0, 0.0, 0.0));
    CHECK(equal(*view.frames(2), *before));
    CHECK(passes(*scene) == 1);
    scene->getDrawable()->setPaused(false);
    CHECK_FALSE(equal(*view.frames(), *before));
}

TEST_CASE("drawable: exposure changes the picture without tracing anew", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene =
        tracedScene(unlitSquare(1.0f, osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f)).get());
    scene->getSettings()->setMaxPasses(1);
    TestViewer view(kSize, kSize, scene.get());
    CHECK(pixel(*view.frames(), kMiddle, kMiddle).r() == 51.0f);
    scene->getSettings()->setExposure(1.0f);
    CHECK(pixel(*view.frames(), kMiddle, kMiddle).r() > 60.0f);
    CHECK(passes(*scene) == 1);
}

TEST_CASE("drawable: denoising changes the picture without tracing anew, and follows the view",
          "[gl][denoise]")
{
    osg::ref_ptr<osg::Group> room = new osg::Group;
    room->addChild(sphere(osg::Vec3(), 2.0f, osg::Vec4(0.7f, 0.5f, 0.3f, 1.0f)));
    room->addChild(sphere(osg::Vec3(1.0f, 2.0f, 2.0f), 0.7f, osg::Vec4(0.2f, 0.5f, 0.8f, 1.0f)));
    room->addChild(new AreaLight(osg::Vec3(-1.0f, 4.0f, 3.0f), osg::Vec3(2.0f, 0.0f, 0.0f),
                                 osg::Vec3(0.0f, 0.0f, 2.0f), osg::Vec3(9.0f, 9.0f, 9.0f)));
    osg::ref_ptr<RayTracedScene> scene = tracedScene(room.get());
    scene->getSettings()->setIntegrator(RayTraceSettings::PATH);
    scene->getSettings()->setMaxPasses(1);
    TestViewer view(kSize, kSize, scene.get());
    const osg::ref_ptr<osg::Image> plain = view.frames();
    CHECK(scene->getDrawable()->getStatistics().denoiseMilliseconds == 0.0);

    scene->getSettings()->setDenoise(RayTraceSettings::FILTER);
    const osg::ref_ptr<osg::Image> denoised = view.frames();
    CHECK(meanDifference(*denoised, *plain) > 0.5);
    CHECK(passes(*scene) == 1);
    CHECK(scene->getDrawable()->getStatistics().cameraRays == unsigned(kSize * kSize));
    CHECK(scene->getDrawable()->getStatistics().denoiseMilliseconds > 0.0);

    view.look(osg::Vec3d(3.0, 1.0, 10.0), osg::Vec3d(0.5, 0.0, 0.0));
    const osg::ref_ptr<osg::Image> moved = view.frames();
    osg::ref_ptr<RayTracedScene> other = tracedScene(room.get());
    other->setSettings(scene->getSettings());
    TestViewer fresh(kSize, kSize, other.get());
    fresh.look(osg::Vec3d(3.0, 1.0, 10.0), osg::Vec3d(0.5, 0.0, 0.0));
    // The fresh scene has another origin, and so other roundings.
    CHECK(meanDifference(*fresh.frames(), *moved) < 0.1);

    scene->getSettings()->setDenoise(RayTraceSettings::OFF);
    CHECK(meanDifference(*view.frames(), *moved) > 0.5);
    CHECK(passes(*scene) == 1);
}

TEST_CASE("drawable: near and far planes are computed from the scene", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    TestViewer view(kSize, kSize, scene.get());
    view.camera().setComputeNearFarMode(
        GENERATE(osg::Camera::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES,
                 osg::Camera::COMPUTE_NEAR_FAR_USING_PRIMITIVES));
    // The eye is so far away that the scene is far behind the projection's far plane, or so near
    // that it is in front of the near plane.
    view.look(osg::Vec3d(0.0, 0.0, GENERATE(2000.0, 0.5)));
    view.camera().setProjectionMatrixAsPerspective(
        view.camera().getViewMatrix().getTrans().z() < -1000.0 ? 0.1 : 40.0, 1.0, 1.0, 100.0);
    CHECK(pixel(*view.frames(), kMiddle, kMiddle) == kGreenPixel);
}

TEST_CASE("drawable: an empty scene draws nothing", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(nullptr);
    TestViewer view(kSize, kSize, scene.get());
    CHECK(countGreen(*view.frames(2)) == 0);
    scene->addChild(unlitSquare(1.0f, kGreen));
    CHECK(countGreen(*view.frames()) > 100);
}

TEST_CASE("drawable: a drawable kept longer than its scene draws nothing", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    osg::ref_ptr<RayTraceDrawable> drawable = scene->getDrawable();
    scene = nullptr;
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    drawable->updateScene(stamp.get());
    TestViewer view(kSize, kSize, drawable.get());
    CHECK(countGreen(*view.frames()) == 0);
}
