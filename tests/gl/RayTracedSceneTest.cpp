// RayTracedSceneTest.cpp - the decorator under a viewer: its children, their changes and its way
// back to the rasterizer. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GreenScene.h"
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

TEST_CASE("traced scene: disabled it is the rasterizer, at once, and back", "[gl]")
{
    osg::ref_ptr<osg::Group> plain = new osg::Group;
    plain->addChild(sphere(osg::Vec3(), 2.0f, osg::Vec4(0.7f, 0.5f, 0.3f, 1.0f)));
    TestViewer rasterizer(kSize, kSize, plain.get());
    const osg::ref_ptr<osg::Image> rasterized = rasterizer.frames();

    osg::ref_ptr<RayTracedScene> scene = tracedScene(plain.get());
    showNormals(*scene);
    TestViewer view(kSize, kSize, scene.get());
    CHECK(meanDifference(*view.frames(), *rasterized) > 10.0);
    scene->setEnabled(false);
    CHECK(equal(*view.frames(), *rasterized));
    scene->setEnabled(true);
    CHECK(meanDifference(*view.frames(), *rasterized) > 10.0);
}

TEST_CASE("traced scene: passes add up while nothing changes, and stop at the most", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    scene->getSettings()->setMaxPasses(5);
    scene->getSettings()->setPassesPerFrame(2);
    TestViewer view(kSize, kSize, scene.get());
    for (int expected : {2, 4, 5, 5})
    {
        view.frames();
        CHECK(passes(*scene) == expected);
    }
    CHECK(scene->getDrawable()->getStatistics().cameraRays == 5u * kSize * kSize);
    CHECK(scene->getDrawable()->getStatistics().triangles == 2u);

    view.look(osg::Vec3d(0.0, 0.5, 10.0));
    view.frames();
    CHECK(passes(*scene) == 2);
}

TEST_CASE("traced scene: an image goes on while OSG computes near and far planes", "[gl]")
{
    // OSG's culling clamps the projection of the last frame again in each frame, and its rounding
    // never ends.
    osg::ref_ptr<RayTracedScene> scene = tracedScene(sphere(osg::Vec3(), 1.7f, kGreen).get());
    TestViewer view(kSize, kSize, scene.get());
    view.camera().setComputeNearFarMode(osg::Camera::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    view.look(osg::Vec3d(1.234567, -46.57338, 3.21));
    view.frames(1);
    view.frames(10);
    CHECK(passes(*scene) >= 10);
}

TEST_CASE("traced scene: a change shows in the next frame", "[gl]")
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    osg::ref_ptr<osg::Switch> node = new osg::Switch;
    osg::ref_ptr<osg::Geometry> square = unlitSquare(1.0f, kGreen);
    transform->addChild(node);
    node->addChild(square);
    osg::ref_ptr<RayTracedScene> scene = tracedScene(transform.get());
    TestViewer view(kSize, kSize, scene.get());
    REQUIRE(pixel(*view.frames(), kMiddle, kMiddle) == kGreenPixel);
    REQUIRE(passes(*scene) == 1);

    SECTION("transform")
    {
        transform->setMatrix(osg::Matrix::translate(2.0, 0.0, 0.0));
        const osg::ref_ptr<osg::Image> moved = view.frames();
        CHECK(pixel(*moved, kMiddle, kMiddle) == kBlackPixel);
        CHECK(pixel(*moved, kMiddle + 17, kMiddle) == kGreenPixel);
    }
    SECTION("node mask")
    {
        transform->setNodeMask(0);
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == kBlackPixel);
    }
    SECTION("switch")
    {
        node->setAllChildrenOff();
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == kBlackPixel);
    }
    SECTION("children")
    {
        scene->removeChild(transform.get());
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == kBlackPixel);
    }
    SECTION("vertex colours")
    {
        static_cast<osg::Vec4Array*>(square->getColorArray())->front().set(1.0f, 0.0f, 0.0f, 1.0f);
        square->getColorArray()->dirty();
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == osg::Vec4(255, 0, 0, 255));
    }
    SECTION("vertex colours without a sign, then dirtyScene")
    {
        static_cast<osg::Vec4Array*>(square->getColorArray())->front().set(1.0f, 0.0f, 0.0f, 1.0f);
        view.frames();
        scene->dirtyScene();
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == osg::Vec4(255, 0, 0, 255));
    }
    SECTION("vertices without a sign, then dirtyScene")
    {
        auto& vertices = static_cast<osg::Vec3Array&>(*square->getVertexArray());
        for (osg::Vec3& v : vertices)
            v.x() = 0.5f * (v.x() + 1.0f); // the right half of the former square
        CHECK(pixel(*view.frames(), kMiddle - 4, kMiddle) == kGreenPixel);
        scene->dirtyScene();
        const osg::ref_ptr<osg::Image> halved = view.frames();
        CHECK(pixel(*halved, kMiddle - 4, kMiddle) == kBlackPixel);
        CHECK(pixel(*halved, kMiddle + 4, kMiddle) == kGreenPixel);
    }
    SECTION("state of the decorator itself")
    {
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f));
        material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        scene->getOrCreateStateSet()->setAttribute(material, osg::StateAttribute::OVERRIDE);
        scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON |
                                                               osg::StateAttribute::OVERRIDE);
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == osg::Vec4(0, 0, 255, 255));
        material->setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
        CHECK(pixel(*view.frames(), kMiddle, kMiddle) == osg::Vec4(255, 0, 0, 255));
    }
    SECTION("nothing: the image goes on")
    {
        view.frames();
        CHECK(passes(*scene) == 2);
    }
}

TEST_CASE("traced scene: osgViewer's light is found, and followed", "[gl]")
{
    osg::ref_ptr<osg::Geometry> square = unlitSquare(1.0f, osg::Vec4(1, 1, 1, 1));
    square->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    osg::ref_ptr<RayTracedScene> scene = tracedScene(square.get());
    // The scene is below a transform: the light must be the same in the scene's own coordinates.
    osg::ref_ptr<osg::MatrixTransform> turned =
        new osg::MatrixTransform(osg::Matrix::rotate(osg::PI_4, osg::Vec3d(0.0, 1.0, 0.0)));
    turned->addChild(scene);
    TestViewer view(kSize, kSize, turned.get());
    view.look(osg::Vec3d(5.0, 0.0, 8.0));

    const auto compare = [&]
    {
        scene->setEnabled(true);
        const osg::Vec4 traced = pixel(*view.frames(), kMiddle, kMiddle);
        scene->setEnabled(false);
        const osg::Vec4 rasterized = pixel(*view.frames(), kMiddle, kMiddle);
        CHECK((traced - rasterized).length() <= 2.0f);
        return traced.r();
    };

    view.viewer.setLightingMode(osg::View::HEADLIGHT);
    const float headlight = compare();
    view.viewer.setLightingMode(osg::View::SKY_LIGHT);
    view.viewer.getLight()->setPosition(osg::Vec4(0.0f, 1.0f, 0.4f, 0.0f));
    const float skyLight = compare();
    view.viewer.getLight()->setDiffuse(osg::Vec4(0.2f, 0.2f, 0.2f, 1.0f));
    const float dimmed = compare();
    view.viewer.setLightingMode(osg::View::NO_LIGHT);
    compare();
    CHECK(headlight > skyLight + 20.0f);
    CHECK(skyLight > dimmed + 10.0f);
}

TEST_CASE("traced scene: the background and the light of a view change without a conversion",
          "[gl]")
{
    osg::ref_ptr<osg::Group> content = new osg::Group;
    osg::ref_ptr<osg::Geometry> mirror = unlitSquare(1.5f, osg::Vec4(1, 1, 1, 1));
    osg::ref_ptr<PhysicalMaterial> metal = new PhysicalMaterial;
    metal->setMetallic(1.0f);
    metal->setRoughness(0.0f);
    mirror->getOrCreateStateSet()->setAttribute(metal.get());
    content->addChild(mirror);
    content->addChild(sphere(osg::Vec3(1.5f, 1.0f, 0.0f), 0.7f, osg::Vec4(1, 1, 1, 1)));
    const auto traced = [&content]
    {
        osg::ref_ptr<RayTracedScene> scene = tracedScene(content.get());
        scene->getSettings()->setMaxPasses(20);
        return scene;
    };
    const osg::ref_ptr<RayTracedScene> scene = traced();
    TestViewer view(kSize, kSize, scene.get());
    view.frames(2);
    const uint64_t conversions = scene->getDrawable()->getStatistics().conversions;
    osg::Vec4 background(0.8f, 0.1f, 0.3f, 1.0f);
    const auto checkPicture = [&](const osg::Vec4& light)
    {
        TestViewer fresh(kSize, kSize, traced().get());
        for (TestViewer* each : {&view, &fresh})
        {
            each->camera().setClearColor(background);
            each->viewer.getLight()->setDiffuse(light);
        }
        const osg::ref_ptr<osg::Image> before = view.frames(0), now = view.frames(2);
        CHECK(equal(*now, *fresh.frames(2)));
        CHECK_FALSE(equal(*now, *before));
        CHECK(passes(*scene) == 2);
    };
    checkPicture(osg::Vec4(0.8f, 0.8f, 0.8f, 1.0f));
    checkPicture(osg::Vec4(0.9f, 0.2f, 0.1f, 1.0f));

    // What drifts too slowly to be seen goes on, until it can be seen.
    const auto drift = [&](float step)
    {
        background.x() += step;
        view.camera().setClearColor(background);
        view.frames();
        return passes(*scene);
    };
    for (int i = 0; i < 4; ++i)
        CHECK(drift(1e-6f) == 3 + i);
    CHECK(drift(0.0006f) == 7);
    CHECK(drift(0.0006f) == 1);
    CHECK(scene->getDrawable()->getStatistics().conversions == conversions);
}

TEST_CASE("traced scene: visitors other than cull reach the children", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(0, 0, 5), osg::Vec3d(0, 0, -5));
    osgUtil::IntersectionVisitor visitor(line.get());
    scene->accept(visitor);
    CHECK(line->containsIntersections());
    CHECK(scene->getChild(0)->getNumParents() == 1u);

    struct Count : osg::NodeCallback
    {
        void operator()(osg::Node* node, osg::NodeVisitor* nv) override
        {
            ++calls;
            traverse(node, nv);
        }
        int calls = 0;
    };
    osg::ref_ptr<Count> count = new Count;
    scene->getChild(0)->setUpdateCallback(count);
    TestViewer view(kSize, kSize, scene.get());
    view.frames(3);
    CHECK(count->calls == 3);
}

TEST_CASE("traced scene: what cannot be traced is rasterized, until told to try again", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    showNormals(*scene);
    TestViewer view(kSize, kSize, scene.get());
    view.camera().removeFinalDrawCallback(view.capture.get()); // it would copy all these pixels
    view.camera().setProjectionResizePolicy(osg::Camera::FIXED);
    view.camera().setViewport(0, 0, 20000, 20000); // more pixels than a film holds
    view.frames();
    CHECK_FALSE(scene->getDrawable()->getStatistics().ok);
    CHECK_FALSE(scene->getDrawable()->getStatistics().message.empty());

    view.camera().setViewport(0, 0, kSize, kSize);
    view.camera().addFinalDrawCallback(view.capture.get());
    CHECK(pixel(*view.frames(), kMiddle, kMiddle) == kGreenPixel);
    SECTION("dirtyScene")
    {
        scene->dirtyScene();
    }
    SECTION("setEnabled")
    {
        scene->setEnabled(true);
    }
    CHECK(pixel(*view.frames(), kMiddle, kMiddle) != kGreenPixel);
    CHECK(scene->getDrawable()->getStatistics().ok);
}

TEST_CASE("traced scene: a clone has its own drawable and the same children", "[gl]")
{
    osg::ref_ptr<RayTracedScene> scene = greenScene();
    osg::ref_ptr<RayTracedScene> copy = osg::clone(scene.get(), osg::CopyOp::SHALLOW_COPY);
    CHECK(copy->getDrawable() != scene->getDrawable());
    CHECK(copy->getSettings() == scene->getSettings());
    scene = nullptr;
    TestViewer view(kSize, kSize, copy.get());
    CHECK(pixel(*view.frames(), kMiddle, kMiddle) == kGreenPixel);
}
