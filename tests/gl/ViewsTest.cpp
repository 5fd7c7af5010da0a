// ViewsTest.cpp - several views at once: eyes, viewports, nested cameras, slices of depth. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "DepthPartition.h"
#include "Squares.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/MatrixTransform>

#include <chrono>
#include <ctime>
#include <iostream>
#include <string>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

osg::ref_ptr<osg::DisplaySettings> stereo(osg::DisplaySettings::StereoMode mode)
{
    osg::ref_ptr<osg::DisplaySettings> settings =
        new osg::DisplaySettings(*osg::DisplaySettings::instance());
    settings->setStereo(true);
    settings->setStereoMode(mode);
    settings->setEyeSeparation(0.2f);
    settings->setScreenDistance(5.0f);
    settings->setSplitStereoHorizontalSeparation(0);
    settings->setSplitStereoVerticalSeparation(0);
    return settings;
}

template <class SetUp> double differenceFromOpenGl(const std::string& name, const SetUp& setUp)
{
    const osg::ref_ptr<osg::Image> drawn = picture(squares().get(), setUp);
    const osg::ref_ptr<osg::Image> traced = picture(tracedSquares(64).get(), setUp);
    return differenceInside(name, *drawn, *traced);
}

double cpuSeconds()
{
    return double(std::clock()) / CLOCKS_PER_SEC;
}

} // namespace

TEST_CASE("views: each eye of osgViewer's stereo modes has its own matrices, and goes on", "[gl]")
{
    using Settings = osg::DisplaySettings;
    const struct
    {
        Settings::StereoMode mode;
        const char* name;
    } modes[] = {{Settings::ANAGLYPHIC, "anaglyphic"},
                 {Settings::HORIZONTAL_SPLIT, "horizontal-split"},
                 {Settings::VERTICAL_SPLIT, "vertical-split"},
                 {Settings::HORIZONTAL_INTERLACE, "horizontal-interlace"},
                 {Settings::CHECKERBOARD, "checkerboard"},
                 {Settings::LEFT_EYE, "left-eye"},
                 {Settings::RIGHT_EYE, "right-eye"},
                 {Settings::QUAD_BUFFER, "quad-buffer"}};
    for (const auto& tested : modes)
    {
        CAPTURE(tested.name);
        const auto setUp = [&](TestViewer& view)
        { view.camera().setDisplaySettings(stereo(tested.mode).get()); };
        CHECK(differenceFromOpenGl(std::string("stereo-") + tested.name, setUp) == 0.0);

        const osg::ref_ptr<RayTracedScene> scene = tracedSquares();
        TestViewer view(kSize, kSize, scene.get());
        setUp(view);
        for (int frame = 1; frame <= 4; ++frame)
        {
            view.frames();
            CHECK(statistics(*scene).passes == frame);
        }
    }
}

TEST_CASE("views: viewports and slave cameras in one window", "[gl]")
{
    const auto setUp = [](TestViewer& view)
    {
        // Four cameras draw into the quarters of a window: from the side, through another lens,
        // off-axis, and parallel.
        const osg::Matrixd projections[] = {osg::Matrixd(), osg::Matrixd::scale(1.5, 1.5, 1.0),
                                            osg::Matrixd::translate(0.4, 0.2, 0.0),
                                            osg::Matrixd::rotate(0.2, osg::Vec3d(0, 0, 1))};
        const osg::Matrixd views[] = {osg::Matrixd::rotate(0.1, osg::Vec3d(0, 1, 0)),
                                      osg::Matrixd(), osg::Matrixd(),
                                      osg::Matrixd::translate(0.0, 0.3, -2.0)};
        osg::GraphicsContext* window = view.camera().getGraphicsContext();
        for (int i = 0; i < 4; ++i)
        {
            osg::ref_ptr<osg::Camera> camera = new osg::Camera;
            camera->setGraphicsContext(window);
            camera->setViewport(i % 2 * kSize / 2, i / 2 * kSize / 2, kSize / 2, kSize / 2);
            camera->setClearColor(osg::Vec4(0, 0, 0, 1));
            camera->setRenderOrder(osg::Camera::POST_RENDER);
            camera->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
            if (i == 3) camera->addFinalDrawCallback(view.capture.get());
            view.viewer.addSlave(camera.get(), projections[i], views[i]);
        }
    };
    // The captured picture is the last camera's quarter of the window.
    const osg::ref_ptr<osg::Image> drawn = picture(squares().get(), setUp, 2);
    const osg::ref_ptr<RayTracedScene> scene = tracedSquares();
    TestViewer view(kSize, kSize, scene.get());
    setUp(view);
    for (int frame = 1; frame <= 3; ++frame)
    {
        view.frames();
        CHECK(statistics(*scene).passes == frame);
    }
    scene->getSettings()->setPassesPerFrame(61);
    const osg::ref_ptr<osg::Image> traced = view.frames();
    CHECK(differenceInside("slaves", *drawn, *traced) == 0.0);
}

TEST_CASE("views: a scene that a pass shows twice has an image for each, nested cameras too",
          "[gl]")
{
    const auto twice = [](osg::Node* scene)
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(scene);
        osg::ref_ptr<osg::MatrixTransform> beside = new osg::MatrixTransform(
            osg::Matrixd::scale(0.5, 0.5, 0.5) * osg::Matrixd::translate(-1.5, -1.5, 7.0));
        beside->addChild(scene);
        root->addChild(beside);
        // The scene is also below a turned camera of its own, in the same stage.
        osg::ref_ptr<osg::Camera> nested = new osg::Camera;
        nested->setRenderOrder(osg::Camera::NESTED_RENDER);
        nested->setViewMatrix(osg::Matrixd::rotate(0.4, osg::Vec3d(0, 0, 1)) *
                              osg::Matrixd::translate(3.0, 0.0, -30.0));
        nested->addChild(scene);
        root->addChild(nested);
        return root;
    };
    const osg::ref_ptr<RayTracedScene> scene = tracedSquares();
    TestViewer view(kSize, kSize, twice(scene.get()).get());
    for (int frame = 1; frame <= 4; ++frame)
    {
        view.frames();
        CHECK(statistics(*scene).passes == frame);
    }
    scene->getSettings()->setPassesPerFrame(60);
    const osg::ref_ptr<osg::Image> traced = view.frames();
    const osg::ref_ptr<osg::Image> drawn =
        picture(twice(squares().get()).get(), [](TestViewer&) {});
    // Traced pixels at the edges of near squares hide what is drawn behind them later.
    CHECK(differenceInside("twice", *drawn, *traced) < 0.003);
}

TEST_CASE("views: slices of depth are traced once an eye, and each writes its own depths", "[gl]")
{
    const bool inStereo = GENERATE(false, true);
    const bool orthographic = GENERATE(false, true);
    CAPTURE(inStereo, orthographic);
    const auto setUp = [&](TestViewer& view)
    {
        if (inStereo)
            view.camera().setDisplaySettings(stereo(osg::DisplaySettings::HORIZONTAL_SPLIT).get());
        if (orthographic)
            view.camera().setProjectionMatrixAsOrtho(-4.0, 4.5, -3.0, 5.0, 0.5, 200.0);
        else
            view.camera().setProjectionMatrixAsPerspective(50.0, 1.0, 0.5, 200.0);
    };
    // A square that OSG draws in the same slices composites with the traced ones.
    const osg::ref_ptr<osg::MatrixTransform> raster = new osg::MatrixTransform(
        osg::Matrixd::rotate(1.2, osg::Vec3d(1, 0, 0)) * osg::Matrixd::translate(0.0, -0.5, 3.0));
    raster->addChild(unlitSquare(3.0f, osg::Vec4(1, 0, 1, 1)));
    const auto content = [&](osg::Node* scene, bool sliced)
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        if (sliced) root = new DepthPartition({0.5, 6.0, 15.0, 200.0});
        root->addChild(scene);
        root->addChild(raster);
        return root;
    };

    const osg::ref_ptr<RayTracedScene> scene = tracedSquares();
    TestViewer view(kSize, kSize, content(scene.get(), true).get());
    setUp(view);
    for (int frame = 1; frame <= 4; ++frame)
    {
        view.frames();
        CHECK(statistics(*scene).passes == frame); // not three times as many
    }
    scene->getSettings()->setPassesPerFrame(60);
    const osg::ref_ptr<osg::Image> sliced = view.frames();
    const osg::ref_ptr<osg::Image> whole =
        picture(content(tracedSquares(64).get(), false).get(), setUp);
    const osg::ref_ptr<osg::Image> drawn = picture(content(squares().get(), true).get(), setUp);
    const std::string name =
        std::string("slices") + (inStereo ? "-stereo" : "") + (orthographic ? "-ortho" : "");
    keep(name + "-whole", *whole);
    CHECK(meanDifference(*sliced, *whole) < 0.1);
    CHECK(differenceInside(name, *drawn, *sliced) < 0.004); // at edges, and where slices end

    // Each slice has its picture in the first frame, whether or not the planes move.
    const osg::ref_ptr<RayTracedScene> moving = tracedSquares(64);
    const osg::ref_ptr<osg::Group> root = content(moving.get(), true);
    TestViewer other(kSize, kSize, root.get());
    setUp(other);
    for (const double shift : {0.3, 0.2, 0.1, 0.0})
    {
        static_cast<DepthPartition&>(*root).setPlanes(
            {0.5 + shift, 6.0 - shift, 15.0 + shift, 200.0});
        other.look(osg::Vec3d(shift, 0.0, 10.0));
        const osg::ref_ptr<osg::Image> now = other.frames();
        if (shift == 0.0) CHECK(meanDifference(*now, *whole) < 0.1);
    }
}

TEST_CASE("views: slices of depth are as sharp far from where the view has begun", "[gl]")
{
    // The camera of the last slice draws first, and is the reference for all of them.
    const double size = 0.002;
    const osg::Vec3d far(20000.0, 0.0, 0.0);
    const auto pictureOf = [&](osg::Group* content)
    {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(
            osg::Matrixd::scale(size, size, size) * osg::Matrixd::translate(far));
        place->addChild(squares());
        content->addChild(place);
        content->addChild(squares()); // what the view begins with
        const osg::ref_ptr<osg::Group> slices = new DepthPartition({0.001, 10.0, 1000.0});
        slices->addChild(content);
        TestViewer view(kSize, kSize, slices.get());
        view.look(osg::Vec3d(0.0, 0.0, 10.0));
        view.frames();
        const osg::Vec3d eye = far + osg::Vec3d(0.0, 0.0, 10.0) * size;
        view.look(eye, far);
        return view.frames(3);
    };
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    const osg::ref_ptr<RayTracedScene> scene = tracedScene(empty.get());
    scene->getSettings()->setPassesPerFrame(64);
    const osg::ref_ptr<osg::Image> traced = pictureOf(scene.get());
    const osg::ref_ptr<osg::Image> drawn = pictureOf(empty.get());
    CHECK(differenceInside("slices-far", *drawn, *traced) < 0.004);
}

TEST_CASE("views: eyes and slices that workers trace come to the pictures of frame-locked ones",
          "[gl]")
{
    using Settings = osg::DisplaySettings;
    const Settings::StereoMode mode =
        GENERATE(Settings::ANAGLYPHIC, Settings::VERTICAL_SPLIT, Settings::HORIZONTAL_INTERLACE);
    const bool sliced = GENERATE(false, true);
    CAPTURE(static_cast<int>(mode), sliced);
    const auto content = [&](osg::Node* scene)
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        if (sliced) root = new DepthPartition({0.5, 6.0, 15.0, 200.0});
        root->addChild(scene);
        return root;
    };
    const auto setUp = [&](TestViewer& view)
    {
        view.camera().setDisplaySettings(stereo(mode).get());
        view.camera().setProjectionMatrixAsPerspective(50.0, 1.0, 0.5, 200.0);
    };
    const osg::ref_ptr<RayTracedScene> locked = tracedSquares(), scene = tracedSquares();
    scene->getSettings()->setPresentation(RayTraceSettings::BACKGROUND);
    for (const osg::ref_ptr<RayTracedScene>& each : {locked, scene})
        each->getSettings()->setMaxPasses(3);
    TestViewer exact(kSize, kSize, content(locked.get()).get());
    setUp(exact);
    TestViewer view(kSize, kSize, content(scene.get()).get());
    setUp(view);
    for (const double x : {0.0, 0.4})
    {
        exact.look(osg::Vec3d(x, 0.0, 10.0));
        view.look(osg::Vec3d(x, 0.0, 10.0));
        const osg::ref_ptr<osg::Image> expected = exact.frames(4);
        bool came = false;
        for (int i = 0; i < 20000 && !came; ++i) // more frames than any machine needs
        {
            came = equal(*view.frames(), *expected);
            if (!came) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        CHECK(came);
    }
}

TEST_CASE("views: what a second eye costs with photons", "[.][second-eye]")
{
    // This test prints figures and is run by hand; photons/PhotonPassTest checks that photons are
    // traced once for both eyes.
    const auto integrator = GENERATE(RayTraceSettings::PPM, RayTraceSettings::PHOTON_CAUSTICS);
    const int size = GENERATE(256, 512, 1024);
    const int photons = GENERATE_COPY(65536, size * size); // the default, and one a pixel
    osg::ref_ptr<PhysicalMaterial> glass = new PhysicalMaterial;
    glass->setTransmission(1.0f);
    glass->setRoughness(0.0f);
    osg::ref_ptr<PhysicalMaterial> chalk = new PhysicalMaterial;
    chalk->setRoughness(1.0f);
    const osg::ref_ptr<osg::Node> ball =
        sphere(osg::Vec3(0.0f, 0.0f, 1.5f), 1.0f, osg::Vec4(1, 1, 1, 1));
    ball->getOrCreateStateSet()->setAttribute(glass);
    const osg::ref_ptr<osg::Geometry> floor = unlitSquare(4.0f, osg::Vec4(1, 1, 1, 1));
    floor->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    floor->getOrCreateStateSet()->setAttribute(chalk);
    osg::ref_ptr<osg::Group> box = new osg::Group;
    box->addChild(ball);
    box->addChild(floor);
    box->addChild(new AreaLight(osg::Vec3(-0.5f, -0.5f, 6.0f), osg::Vec3(0.0f, 1.0f, 0.0f),
                                osg::Vec3(1.0f, 0.0f, 0.0f), osg::Vec3(30.0f, 30.0f, 30.0f)));
    const auto secondsOf = [&](bool two)
    {
        const osg::ref_ptr<RayTracedScene> scene = tracedScene(box.get());
        scene->getSettings()->setIntegrator(integrator);
        scene->getSettings()->setPhotons(photons);
        TestViewer view(size, size, scene.get());
        view.viewer.setLightingMode(osg::View::NO_LIGHT);
        view.look(osg::Vec3d(0.0, -9.0, 7.0));
        if (two) view.camera().setDisplaySettings(stereo(osg::DisplaySettings::ANAGLYPHIC).get());
        view.frames();
        const double start = cpuSeconds();
        view.frames(4);
        CHECK(statistics(*scene).passes == 5);
        CHECK(statistics(*scene).storedPhotons > 0);
        return cpuSeconds() - start;
    };
    double mono = 0.0, both = 0.0;
    for (int round = 0; round < 3; ++round)
    {
        mono += secondsOf(false);
        both += secondsOf(true);
    }
    std::cout << (integrator == RayTraceSettings::PPM ? "ppm" : "photon-caustics") << ", stereo at "
              << size << " x " << size << ", " << photons << " photons a pass: " << both / mono
              << " times the CPU time of mono, " << mono / 12.0 << " s a pass" << std::endl;
}
