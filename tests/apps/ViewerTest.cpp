// ViewerTest.cpp - the status line of osgraytraceviewer, and the keys that the viewer handles.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "apps/common/ErrorText.h"
#include "apps/osgraytraceviewer/KeyHandler.h"
#include "apps/osgraytraceviewer/SettingsPanel.h"
#include "apps/osgraytraceviewer/StatusLine.h"
#include "apps/osgraytraceviewer/ViewerOptions.h"
#include "tests/Catch.h"
#include "tests/bridge/Messages.h"
#include "tests/gl/TestViewer.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osg/Material>
#include <osgDB/ReadFile>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgGA/TrackballManipulator>
#include <osgViewer/ViewerEventHandlers>

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace osgRayTrace;
using namespace osgRayTrace::app;
using namespace osgRayTrace::test;
using Catch::Matchers::Contains;

namespace
{

using Event = osgGA::GUIEventAdapter;

/// Returns whether the handler took the event.
bool send(KeyHandler& keys, osgViewer::Viewer& viewer, Event::EventType type, int key)
{
    const osg::ref_ptr<Event> event = new Event;
    event->setEventType(type);
    event->setKey(key);
    return keys.handle(*event, viewer);
}

} // namespace

TEST_CASE("viewer: F freezes the view, and its release toggles nothing however Shift is let go",
          "[apps]")
{
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    osgViewer::Viewer viewer;
    viewer.setCameraManipulator(new osgGA::TrackballManipulator);
    for (const int released : {'f', 'F'})
    {
        CHECK(send(*keys, viewer, Event::KEYDOWN, 'F'));
        CHECK(send(*keys, viewer, Event::KEYUP, released));
        CHECK_FALSE(send(*keys, viewer, Event::KEYUP, released));
    }
    CHECK_FALSE(keys->isFrozen());
    // The key f belongs to osgViewer.
    CHECK_FALSE(send(*keys, viewer, Event::KEYDOWN, 'f'));
    CHECK_FALSE(send(*keys, viewer, Event::KEYUP, 'f'));
    // The handler also takes the releases of its other keys, which further handlers use as well.
    for (const int key : {'i', 'n', 'r', 'p'})
    {
        CHECK(send(*keys, viewer, Event::KEYDOWN, key));
        CHECK(send(*keys, viewer, Event::KEYUP, key));
    }
}

TEST_CASE("viewer: o prints the names of what is under the mouse", "[apps][gl]")
{
    const osg::ref_ptr<osg::ShapeDrawable> ball = sphere(osg::Vec3(), 2.0f, osg::Vec4(1, 1, 1, 1));
    ball->setName("ball");
    osg::ref_ptr<osg::Material> chrome = new osg::Material;
    chrome->setName("chrome");
    ball->getOrCreateStateSet()->setAttribute(chrome);
    const osg::ref_ptr<RayTracedScene> scene = tracedScene(ball);
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    TestViewer viewer(32, 32, scene);
    viewer.frames(1);
    const auto printed = [&](float x)
    {
        const engine::test::Messages messages;
        osg::setNotifyLevel(osg::NOTICE);
        const osg::ref_ptr<Event> event = new Event;
        event->setEventType(Event::KEYDOWN);
        event->setKey('o');
        event->setInputRange(-1.0f, -1.0f, 1.0f, 1.0f);
        event->setX(x);
        event->setY(0.0f);
        CHECK(keys->handle(*event, viewer.viewer));
        return messages.text();
    };
    CHECK_THAT(printed(0.0f), Contains("/ball\n") && Contains("material\tchrome\t-\n"));
    CHECK(printed(0.99f) == "nothing is under the mouse\n");
}

TEST_CASE("viewer: v goes from camera to camera of the model", "[apps]")
{
    const osg::ref_ptr<osg::Group> model = new osg::Group;
    for (const int number : {1, 2})
    {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(0, 0, 10 * number));
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setName("camera" + std::to_string(number));
        camera->setProjectionMatrixAsPerspective(20.0 * number, 1.0, 1.0, 100.0);
        place->addChild(camera);
        model->addChild(place);
    }
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(model);
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    osgViewer::Viewer viewer;
    viewer.setCameraManipulator(new osgGA::TrackballManipulator);
    const engine::test::Messages messages;
    for (const int number : {1, 2, 1})
    {
        CHECK(send(*keys, viewer, Event::KEYDOWN, 'v'));
        CHECK(viewer.getCameraManipulator()->getMatrix().getTrans().z() == Approx(10.0 * number));
        double fovy = 0.0, aspect = 0.0, nearest = 0.0, farthest = 0.0;
        viewer.getCamera()->getProjectionMatrixAsPerspective(fovy, aspect, nearest, farthest);
        CHECK(fovy == Approx(20.0 * number));
    }
}

TEST_CASE("viewer: E writes the view as options that give it again", "[apps]")
{
    const TemporaryFolder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(new RayTracedScene);
    osgViewer::Viewer viewer;
    osg::Camera& camera = *viewer.getCamera();
    camera.setViewMatrixAsLookAt({1, 2, 3}, {1, 12, 3}, {0, 0, 1});
    camera.setProjectionMatrixAsPerspective(30.0, 1.5, 1.0, 100.0);
    CHECK(send(*keys, viewer, Event::KEYDOWN, 'E'));
    camera.setProjectionMatrixAsOrtho(-3, 3, -2, 2, 1.0, 100.0);
    CHECK(send(*keys, viewer, Event::KEYDOWN, 'E'));
    std::filesystem::current_path(before);

    const ViewOptions view = readViewFile(folder / "osgraytrace-1.view");
    CHECK((*view.eye - osg::Vec3d(1, 2, 3)).length() < 1e-9);
    CHECK((*view.center - osg::Vec3d(1, 3, 3)).length() < 1e-9);
    CHECK((*view.up - osg::Vec3d(0, 0, 1)).length() < 1e-9);
    CHECK(*view.fovyDegrees == Approx(30.0));
    CHECK_FALSE(view.height);
    CHECK(*readViewFile(folder / "osgraytrace-2.view").height == Approx(4.0));

    std::ofstream(folder / "bad.view") << "--eye 1 2";
    CHECK_THROWS_WITH(readViewFile(folder / "bad.view"), Contains("'--eye' does not begin"));
    std::ofstream(folder / "empty.view");
    CHECK_THROWS_WITH(readViewFile(folder / "empty.view"), Contains("it holds no view"));
}

TEST_CASE("viewer: C writes what the window shows", "[apps][gl]")
{
    const TemporaryFolder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    const osg::ref_ptr<RayTracedScene> scene =
        tracedScene(sphere(osg::Vec3(), 2.0f, osg::Vec4(1, 1, 1, 1)));
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    TestViewer viewer(32, 32, scene);
    viewer.camera().addFinalDrawCallback(keys->windowPicture());
    viewer.frames(1);
    CHECK(send(*keys, viewer.viewer, Event::KEYDOWN, 'C'));
    const osg::ref_ptr<osg::Image> shown = viewer.frames(1);
    viewer.frames(1); // one picture is enough
    std::filesystem::current_path(before);
    CHECK(folder.fileNames() == std::vector<std::string>{"osgraytrace-1.png"});
    const osg::ref_ptr<osg::Image> written = osgDB::readRefImageFile(folder / "osgraytrace-1.png");
    REQUIRE(written);
    for (const auto& [x, y] : {std::pair(16u, 16u), std::pair(12u, 18u), std::pair(1u, 1u)})
        CHECK(written->getColor(x, y).g() == Approx(shown->getColor(x, y).g()).margin(0.004));
}

TEST_CASE("viewer: the manipulators of osgviewer take the view that is asked for", "[apps]")
{
    osgViewer::Viewer viewer;
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(sphere(osg::Vec3(), 2.0f, osg::Vec4(1, 1, 1, 1)));
    ViewerOptions options;
    options.view.eye = osg::Vec3d(0.0, -9.0, 0.0);
    options.view.fovyDegrees = 50.0;
    addManipulators(viewer, options);
    showView(viewer, *scene, options);
    CHECK((viewer.getCameraManipulator()->getMatrix().getTrans() - osg::Vec3d(0, -9, 0)).length() <
          1e-6);
    double fovy = 0.0, aspect = 0.0, nearest = 0.0, farthest = 0.0;
    viewer.getCamera()->getProjectionMatrixAsPerspective(fovy, aspect, nearest, farthest);
    CHECK(fovy == Approx(50.0));
    const auto* keys =
        dynamic_cast<osgGA::KeySwitchMatrixManipulator*>(viewer.getCameraManipulator());
    REQUIRE(keys);
    for (const int key : {'1', '2', '3', '4', '5', '6'})
        CHECK(keys->getMatrixManipulatorWithKey(static_cast<unsigned int>(key)));
    options.camera = "no such camera";
    CHECK_THROWS_WITH(showView(viewer, *scene, options), Contains("there is no such file"));
}

TEST_CASE("viewer: variables add lights unless the pseudo-loader does", "[apps]")
{
    const auto hasSun = [](std::string model)
    {
        std::string program = "osgraytraceviewer";
        int argc = 2;
        char* argv[] = {program.data(), model.data(), nullptr};
        osg::ArgumentParser arguments(&argc, argv);
        return readViewerOptions(arguments).lights.sun.has_value();
    };
    setenv("OSGRAYTRACE_SUN", "77:30", 1);
    CHECK(hasSun("cow.osgt"));
    CHECK_FALSE(hasSun("cow.osgt.raytrace"));
    CHECK_FALSE(hasSun("cow.osgt.RayTrace"));
    unsetenv("OSGRAYTRACE_SUN");
    CHECK_FALSE(hasSun("cow.osgt"));
}

TEST_CASE("viewer: the status line says how far the picture is, and what is not as usual",
          "[apps][gl]")
{
    const osg::ref_ptr<RayTracedScene> scene =
        tracedScene(sphere(osg::Vec3(), 2.0f, osg::Vec4(1, 1, 1, 1)));
    RayTraceSettings& settings = *scene->getSettings();
    settings.setMaxPasses(3);
    TestViewer viewer(32, 32, scene);
    viewer.frames(2);
    CHECK_THAT(statusText(*scene, false), Contains("whitted   2 of 3 passes") &&
                                              !Contains("done") && Contains(" M rays/s") &&
                                              Contains(" %") && !Contains("frozen") &&
                                              !Contains("resolution") && !Contains("exposure"));
    viewer.frames(3);
    settings.setExposure(1.5f);
    CHECK_THAT(statusText(*scene, true), Contains("3 of 3 passes, done") &&
                                             Contains("exposure +1.5 EV") && Contains("   frozen"));
    settings.setExposure(-0.5f);
    scene->getDrawable()->setPaused(true);
    CHECK_THAT(statusText(*scene, true),
               Contains("exposure -0.5 EV") && Contains("frozen   paused"));
    scene->setEnabled(false);
    CHECK(statusText(*scene, false) == "rasterizer");
}

TEST_CASE("viewer: the status line becomes lines where a window is narrow", "[apps]")
{
    CHECK(wrapped("a b   c   d", 99.0) == "a b   c   d");
    CHECK(wrapped("a b   c   d", 8.0) == "a b   c\nd");
    CHECK(wrapped("a b   c   d", 1.0) == "a b\nc\nd");
    CHECK(wrapped("", 5.0).empty());
}

TEST_CASE("viewer: decimal points of the status line can be seen", "[apps][gl]")
{
    // The picture is the line alone, with an error of one digit: the test counts pixels of the
    // text's colour at the place of the point.
    const osg::ref_ptr<RayTracedScene> scene = tracedScene(nullptr);
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    const osg::ref_ptr<StatusLine> line = new StatusLine(scene, keys);
    osgText::Text& text =
        *dynamic_cast<osgText::Text*>(line->camera()->getChild(0)->asGroup()->getChild(0));
    line->camera()->setProjectionMatrixAsOrtho2D(0.0, 96.0, 0.0, 32.0);
    TestViewer viewer(96, 32, line->camera());
    viewer.camera().setClearColor(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f)); // the worst background
    const auto brightPixels = [&](const char* words)
    {
        text.setText(words);
        const osg::ref_ptr<osg::Image> picture = viewer.frames(2);
        int bright = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 8; x < 50; ++x)
                bright += pixel(*picture, x, y).x() > 100.0f && y > 6 && y < 28;
        return bright;
    };
    const int without = brightPixels("8  8"), with = brightPixels("8. 8");
    CAPTURE(without, with);
    CHECK(with > without);
    CHECK(without < 42 * 21 / 2); // most of the plate is dark
}

TEST_CASE("errors are written in percent, and in words from 100 % on", "[apps]")
{
    CHECK(errorText(0.018) == "1.8 %");
    CHECK(errorText(0.00012) == "0.012 %");
    CHECK(errorText(0.99) == "99 %");
    CHECK(errorText(0.996) == "100 % or more, mostly noise");
    CHECK(errorText(12.0) == "100 % or more, mostly noise");

    osgRayTrace::Statistics statistics;
    statistics.relativeError = 0.36;
    statistics.medianError = 0.029;
    statistics.worstErrorShare = 0.881;
    CHECK(estimateText(statistics) ==
          "36 % (median tile 2.9 %, the worst 0.1 % of the pixels hold 88 % of its square)");
}

namespace
{

/// Returns whether the panel took the key.
bool sendTo(SettingsPanel& panel, osgViewer::Viewer& viewer, int key)
{
    const osg::ref_ptr<Event> event = new Event;
    event->setEventType(Event::KEYDOWN);
    event->setKey(key);
    return panel.handle(*event, viewer);
}

} // namespace

TEST_CASE("viewer: the panel changes settings by arrows and clicks while it is open", "[apps]")
{
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    RayTraceSettings& settings = *scene->getSettings();
    const osg::ref_ptr<SettingsPanel> panel = new SettingsPanel(scene);
    osgViewer::Viewer viewer;
    CHECK_FALSE(sendTo(*panel, viewer, Event::KEY_Right)); // arrows belong to manipulators
    CHECK(sendTo(*panel, viewer, Event::KEY_Tab));
    CHECK(panel->isOpen());
    CHECK_FALSE(sendTo(*panel, viewer, 'i'));
    const auto press = [&](int key, int times)
    {
        for (int i = 0; i < times; ++i)
            CHECK(sendTo(*panel, viewer, key));
    };
    press(Event::KEY_Right, 2);
    CHECK(settings.get("integrator") == "path");
    press(Event::KEY_Left, 3);
    CHECK(settings.get("integrator") == "debug"); // around the end
    press(Event::KEY_Down, 2);
    press(Event::KEY_Right, 1);
    CHECK(settings.getLightSamples() == 8);
    press(Event::KEY_Left, 5);
    CHECK(settings.getLightSamples() == 1);
    press(Event::KEY_Down, 1);
    press(Event::KEY_Left, 10);
    CHECK(settings.getMaxBounces() == 0);
    press(Event::KEY_Down, 3);
    press(Event::KEY_Right, 3);
    CHECK(settings.getExposure() == 1.5f);
    press(Event::KEY_Up, 7);
    press(Event::KEY_Right, 1);
    CHECK(settings.getGround() == "auto");
    CHECK_THAT(panel->lines().back(), Contains("> ground") && Contains("< auto >"));

    // The window is 200 pixels high; the first row is below the title.
    const auto click = [&](float x, float fromTop)
    {
        const osg::ref_ptr<Event> event = new Event;
        event->setEventType(Event::PUSH);
        event->setInputRange(0.0f, 0.0f, 400.0f, 200.0f);
        event->setMouseYOrientation(Event::Y_INCREASING_UPWARDS);
        event->setX(x);
        event->setY(200.0f - fromTop);
        return panel->handle(*event, viewer);
    };
    CHECK(click(300.0f, 37.0f));
    CHECK(settings.get("integrator") == "auto");
    CHECK(click(40.0f, 37.0f));
    CHECK(settings.get("integrator") == "debug");
    CHECK_FALSE(click(40.0f, 20.0f));
    CHECK_FALSE(click(390.0f, 37.0f));
    CHECK(sendTo(*panel, viewer, Event::KEY_Tab));
    CHECK_FALSE(panel->isOpen());
    CHECK_FALSE(click(40.0f, 37.0f));
}

TEST_CASE("viewer: x lets the exposure follow the picture's mean, and is told", "[apps][gl]")
{
    const osg::ref_ptr<RayTracedScene> scene =
        tracedScene(sphere(osg::Vec3(), 2.0f, osg::Vec4(0.02f, 0.02f, 0.02f, 1)));
    const osg::ref_ptr<KeyHandler> keys = new KeyHandler(scene);
    RayTraceSettings& settings = *scene->getSettings();
    settings.setMaxPasses(64);
    TestViewer viewer(32, 32, scene);
    const osg::ref_ptr<osg::Image> plain = viewer.frames(2);
    CHECK(scene->getDrawable()->getStatistics().autoExposure == 0.0);
    const float dark = plain->getColor(16, 16).g();
    CHECK(send(*keys, viewer.viewer, Event::KEYDOWN, 'x'));
    const float bright = viewer.frames(2)->getColor(16, 16).g();
    const double first = scene->getDrawable()->getStatistics().autoExposure;
    CHECK(first > 2.0);
    CHECK(bright > dark + 0.2f);
    CHECK_THAT(statusText(*scene, false), Contains("automatic"));
    viewer.frames(20);
    CHECK(scene->getDrawable()->getStatistics().autoExposure == first); // nothing flickers
    CHECK(scene->getDrawable()->getStatistics().passes > 20);           // and nothing restarts
    CHECK(send(*keys, viewer.viewer, Event::KEYDOWN, 'x'));
    CHECK(viewer.frames(2)->getColor(16, 16).g() == Approx(dark).margin(0.01));
}
