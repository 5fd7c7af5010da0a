// RendererLightsTest.cpp - lights and shadows in rendered images.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"

#include <osg/CullFace>
#include <osg/LightSource>

#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

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
