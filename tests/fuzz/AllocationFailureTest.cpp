// AllocationFailureTest.cpp - every allocation of a render fails once: the failure is reported, and
// nothing else goes wrong. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "tests/Catch.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/Renderer>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/Texture2D>

#include <cstring>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

osg::ref_ptr<osg::Texture2D> checkered()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 12; ++i)
        image->data()[i] = static_cast<unsigned char>(40 * i);
    return new osg::Texture2D(image);
}

/// Returns a scene that uses every part of a render: instances, a texture, glass, a mirror, an
/// emissive mesh and an area light.
osg::ref_ptr<osg::Node> smallScene()
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Geometry> floor = osg::createTexturedQuadGeometry(
        osg::Vec3(-2, -2, -1), osg::Vec3(4, 0, 0), osg::Vec3(0, 4, 0));
    floor->getOrCreateStateSet()->setTextureAttributeAndModes(0, checkered());
    root->addChild(floor);
    const osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry(
        osg::Vec3(-0.4f, -0.4f, 0), osg::Vec3(0.8f, 0, 0), osg::Vec3(0, 0.8f, 0));
    for (int i = 0; i < 3; ++i)
    {
        osg::ref_ptr<osg::MatrixTransform> placed =
            new osg::MatrixTransform(osg::Matrix::translate(i - 1.0, 0.2 * i, 0.0));
        osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
        if (i == 0) material->setTransmission(1.0f);
        if (i == 1) material->setMetallic(1.0f);
        if (i == 2) material->setEmission(osg::Vec3(1, 2, 3));
        material->setRoughness(0.0f);
        placed->getOrCreateStateSet()->setAttribute(material);
        placed->addChild(square);
        root->addChild(placed);
    }
    root->addChild(new AreaLight(osg::Vec3(-1, -1, 3), osg::Vec3(0, 2, 0), osg::Vec3(2, 0, 0),
                                 osg::Vec3(5, 5, 5)));
    return root;
}

osg::ref_ptr<Renderer> rendererOf(osg::Node* scene)
{
    osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(scene);
    renderer->setSize(24, 20);
    renderer->setViewMatrix(
        osg::Matrixd::lookAt(osg::Vec3d(1, -3, 4), osg::Vec3d(), osg::Vec3d(0, 0, 1)));
    renderer->setProjectionMatrix(osg::Matrixd::perspective(40.0, 1.2, 0.5, 50.0));
    renderer->getSettings()->setIntegrator(RayTraceSettings::PATH);
    renderer->getSettings()->setMaxPasses(2);
    renderer->getSettings()->setThreads(2);
    return renderer;
}

bool samePicture(const osg::Image* a, const osg::Image* b)
{
    return a && b && a->getTotalSizeInBytes() == b->getTotalSizeInBytes() &&
           std::memcmp(a->data(), b->data(), a->getTotalSizeInBytes()) == 0;
}

/// Lets allocation 0, 1, 2, ... fail until a render has no such allocation. Returns how many
/// renders failed.
int sweep(Failing failing, osg::Node* scene, const osg::Image* expected)
{
    int failures = 0;
    for (int n = 0;; ++n)
    {
        CAPTURE(n, int(failing));
        const osg::ref_ptr<Renderer> renderer = rendererOf(scene);
        bool rendered = false, failed = false;
        {
            const FailingMemory memory(n, failing);
            rendered = renderer->render();
            failed = memory.failed();
        }
        if (!rendered)
        {
            ++failures;
            REQUIRE(failed);
            REQUIRE_FALSE(renderer->getStatistics().ok);
            REQUIRE_FALSE(renderer->getStatistics().message.empty());
            REQUIRE(renderer->render());
        }
        // A render that did not fail, or failed and was repeated, gives the picture that it gives
        // without failures.
        REQUIRE(renderer->getStatistics().passes == 2);
        REQUIRE(renderer->getStatistics().droppedSamples == 0);
        REQUIRE(renderer->getStatistics().cameraRays == 1024u * 2u); // whole tiles
        REQUIRE(samePicture(renderer->getColorImage().get(), expected));
        if (!failed) return failures;
    }
}

} // namespace

TEST_CASE(
    "stability 52: each failing allocation of a render is reported, and the next try is right",
    "[stability][fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    const osg::ref_ptr<osg::Node> scene = smallScene();
    const osg::ref_ptr<Renderer> calm = rendererOf(scene);
    REQUIRE(calm->render());
    const osg::ref_ptr<osg::Image> expected = calm->getColorImage();

    for (const Failing failing : {Failing::Once, Failing::Onward})
    {
        CHECK(sweep(failing, scene, expected) > 100);
        // Objects that a process allocates only once exist now; a leak would grow with each
        // failure.
        const int64_t before = liveAllocations();
        const int failures = sweep(failing, scene, expected);
        CAPTURE(failures, liveAllocations() - before);
        CHECK(liveAllocations() - before < failures / 10);
    }
}
