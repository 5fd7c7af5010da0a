// ViewsTest.cpp - several views at once: eyes, viewports, nested cameras, slices of depth. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "DepthPartition.h"
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/MatrixTransform>
#include <osgDB/WriteFile>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 96;

/// Returns unlit squares whose edges do not meet: two ways to draw them may differ only at edges.
osg::ref_ptr<osg::Group> squares()
{
    const struct
    {
        osg::Vec3d at;
        float half;
        osg::Vec4 color;
    } all[] = {{{0.3, 0.2, 6.0}, 0.6f, {1, 0, 0, 1}},
               {{-1.0, 0.4, 2.0}, 1.2f, {0, 1, 0, 1}},
               {{1.5, -1.0, -8.0}, 4.0f, {0, 0, 1, 1}},
               {{-6.0, 8.0, -70.0}, 20.0f, {1, 1, 0, 1}}};
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const auto& square : all)
    {
        // The squares are tilted, so that the slices cut them.
        osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::rotate(0.7, osg::Vec3d(0.3, 1.0, 0.0)) *
                                     osg::Matrixd::translate(square.at));
        place->addChild(unlitSquare(square.half, square.color));
        group->addChild(place);
    }
    return group;
}

osg::ref_ptr<RayTracedScene> tracedSquares(int passesPerFrame = 1)
{
    osg::ref_ptr<RayTracedScene> scene = tracedScene(squares().get());
    scene->getSettings()->setPassesPerFrame(passesPerFrame);
    return scene;
}

Statistics statistics(const RayTracedScene& scene)
{
    return scene.getDrawable()->getStatistics();
}

void keep(const std::string& name, const osg::Image& image)
{
    if (const char* folder = std::getenv("OSGRAYTRACE_PICTURES"))
        osgDB::writeImageFile(image, std::string(folder) + "/" + name + ".png");
}

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

/// Returns the picture, after this many frames, of a scene whose viewer is prepared by setUp.
template <class SetUp>
osg::ref_ptr<osg::Image> picture(osg::Node* scene, const SetUp& setUp, int frames = 1)
{
    TestViewer view(kSize, kSize, scene);
    setUp(view);
    return view.frames(frames);
}

/// Returns the share of the pixels of one colour to which OpenGL gives another colour: it is not
/// small if matrices or eyes differ.
double differenceInside(const std::string& name, const osg::Image& drawn, const osg::Image& traced)
{
    keep(name + "-osg", drawn);
    keep(name + "-traced", traced);
    REQUIRE((drawn.s() == traced.s() && drawn.t() == traced.t()));
    long inside = 0, wrong = 0, colored = 0;
    for (int y = 0; y < drawn.t(); ++y)
        for (int x = 0; x < drawn.s(); ++x)
        {
            const osg::Vec4 t = pixel(traced, x, y);
            bool pure = true;
            for (int c = 0; c < 3; ++c)
                pure = pure && (t[c] == 0.0f || t[c] == 255.0f);
            if (!pure) continue;
            ++inside;
            colored += t.r() + t.g() + t.b() > 0.0f;
            wrong += (t - pixel(drawn, x, y)).length() > 0.0f;
        }
    CHECK(inside > drawn.s() * drawn.t() * 3 / 4);
    CHECK(colored > drawn.s() * drawn.t() / 8);
    return double(wrong) / double(inside);
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

TEST_CASE("views: what node masks hide from some views is OSG's", "[gl]")
{
    const auto masked = []
    {
        osg::ref_ptr<osg::Group> group = squares();
        group->getChild(0)->setNodeMask(1);
        group->getChild(1)->asGroup()->getChild(0)->setNodeMask(2);
        return group;
    };
    for (int captured = 0; captured < 2; ++captured)
    {
        CAPTURE(captured);
        const auto setUp = [captured](TestViewer& view)
        {
            for (int i = 0; i < 2; ++i)
            {
                osg::ref_ptr<osg::Camera> camera = new osg::Camera;
                camera->setGraphicsContext(view.camera().getGraphicsContext());
                camera->setViewport(i * kSize / 2, 0, kSize / 2, kSize);
                camera->setClearColor(osg::Vec4(0, 0, 0, 1));
                camera->setRenderOrder(osg::Camera::POST_RENDER);
                camera->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
                camera->setCullMask(1u << i);
                if (i == captured) camera->addFinalDrawCallback(view.capture.get());
                view.viewer.addSlave(camera.get());
            }
        };
        const osg::ref_ptr<osg::Image> drawn = picture(masked().get(), setUp, 2);
        const osg::ref_ptr<RayTracedScene> scene = tracedScene(masked().get());
        scene->getSettings()->setPassesPerFrame(61);
        TestViewer view(kSize, kSize, scene.get());
        setUp(view);
        const osg::ref_ptr<osg::Image> traced = view.frames(3);
        CHECK(differenceInside("masks", *drawn, *traced) == 0.0);
        CHECK(statistics(*scene).conversion["rasterized.view-mask"] == 2);
        CHECK(statistics(*scene).conversions <= 3); // one for each view of the first frame
    }
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
