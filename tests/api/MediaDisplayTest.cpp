// MediaDisplayTest.cpp - pictures of media before nothing.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/api/RenderedRoom.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

#include <cstdlib>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// A glowing body that absorbs, of a depth of 2 along y. Behind its right half stands a black wall,
/// behind its left one nothing.
osg::ref_ptr<osg::Group> glowBeforeHalfAWall()
{
    const osg::ref_ptr<Medium> glow = new Medium;
    glow->setAbsorption(osg::Vec3(0.2f, 0.4f, 0.8f));
    glow->setEmission(osg::Vec3(0.1f, 0.05f, 0.02f));
    const osg::ref_ptr<PhysicalMaterial> air = new PhysicalMaterial;
    air->setTransmission(1.0f);
    air->setRoughness(0.0f);
    air->setIor(1.0f);
    air->setInterior(glow.get());
    const osg::ref_ptr<osg::Geode> body = new osg::Geode;
    body->addDrawable(
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(0.0f, 0.0f, 0.0f), 20.0f, 2.0f, 20.0f)));
    body->getOrCreateStateSet()->setAttribute(air.get());
    const osg::ref_ptr<PhysicalMaterial> black = new PhysicalMaterial;
    black->setBaseColor(osg::Vec3(0.0f, 0.0f, 0.0f));
    black->setIor(1.0f);
    const osg::ref_ptr<osg::Geode> wall = quad(
        osg::Vec3(0.0f, 2.0f, -10.0f), osg::Vec3(10.0f, 0.0f, 0.0f), osg::Vec3(0.0f, 0.0f, 20.0f));
    wall->getOrCreateStateSet()->setAttribute(black.get());
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(body);
    scene->addChild(wall);
    return scene;
}

osg::ref_ptr<Renderer> rendered(osg::Node* scene)
{
    const osg::ref_ptr<Renderer> renderer = rendererOf(scene);
    renderer->setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    renderer->setViewMatrix(
        osg::Matrix::lookAt(osg::Vec3d(0.0, -20.0, 0.0), osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0)));
    renderer->setProjectionMatrix(osg::Matrix::ortho(-3.0, 3.0, -2.0, 2.0, 1.0, 100.0));
    REQUIRE(renderer->render());
    return renderer;
}

/// Returns the greatest difference between the left and the right half of the picture.
int step(const osg::Image& image)
{
    int most = 0;
    for (int y = 0; y < image.t(); ++y)
        for (int c = 0; c < 3; ++c)
            most = std::max(most, std::abs(image.data(4, y)[c] - image.data(image.s() - 5, y)[c]));
    return most;
}

} // namespace

TEST_CASE("renderer: a glow before nothing looks as before a wall of the clear colour",
          "[api][renderer][media]")
{
    const osg::ref_ptr<Renderer> renderer = rendered(glowBeforeHalfAWall());
    const osg::ref_ptr<osg::Image> radiance = renderer->getColorImage();
    REQUIRE(floats(*radiance)[4 * 4 + 3] < 0.7f); // nothing is seen through the left half
    const osg::ref_ptr<osg::Image> display = renderer->getDisplayImage();
    REQUIRE(display->data(4, 4)[0] > 60);
    CHECK(step(*display) <= 1);

    const PassSums sums = renderer->getPassSums();
    CHECK(sums.veiled);
    CHECK(sameBytes(sums.getDisplayImage(0.0f, osg::Vec4(0, 0, 0, 1)), display.get()));

    const osg::ref_ptr<osg::Image> black = new osg::Image;
    black->allocateImage(48, 32, 1, GL_RGBA, GL_UNSIGNED_BYTE, 1);
    std::memset(black->data(), 0, black->getTotalSizeInBytes());
    const osg::ref_ptr<osg::Image> over = renderer->getDisplayImage(black.get());
    REQUIRE(over);
    CHECK(step(*over) <= 1);
    CHECK(over->data(4, 4)[3] == 255);

    // Over nothing, colours are encoded without alpha and multiplied with it.
    const osg::ref_ptr<osg::Image> alone = renderer->getDisplayImage(nullptr);
    REQUIRE(alone);
    CHECK(alone->data(4, 4)[3] < 180);
    CHECK(alone->data(4, 4)[0] <= alone->data(4, 4)[3]);
}

TEST_CASE("renderer: pictures without media are the same over a colour and over its image",
          "[api][renderer][media]")
{
    const osg::ref_ptr<Renderer> renderer = rendererOf(room());
    renderer->setClearColor(osg::Vec4(0.2f, 0.4f, 0.6f, 1.0f));
    REQUIRE(renderer->render());
    const osg::ref_ptr<osg::Image> blue = new osg::Image;
    blue->allocateImage(48, 32, 1, GL_RGBA, GL_UNSIGNED_BYTE, 1);
    for (int i = 0; i < 48 * 32; ++i)
        for (int c = 0; c < 4; ++c)
            blue->data()[4 * i + c] = static_cast<unsigned char>(51 * (c + 1));
    CHECK(sameBytes(renderer->getDisplayImage(), renderer->getDisplayImage(blue.get())));
    CHECK_FALSE(renderer->getPassSums().veiled);
    blue->allocateImage(47, 32, 1, GL_RGBA, GL_UNSIGNED_BYTE, 1);
    CHECK_FALSE(renderer->getDisplayImage(blue.get()));
}
