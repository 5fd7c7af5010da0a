// ExitProgram.cpp - a program that goes on drawing while another thread ends it. Layer: tests.
// SPDX-License-Identifier: MIT
//
// Usage: exitProgram plain|frame-locked|background|renderer FRAMES MILLISECONDS
//
// After FRAMES frames another thread calls exit(). A handler of the host then takes MILLISECONDS,
// in which frames go on. The handler is registered when OpenGL has drawn and nothing has been
// traced. So all static objects that tracing has constructed are destroyed before the handler runs.
// OpenGL's static objects, without which no program can draw, are destroyed after it. If
// MILLISECONDS is 0 there is no handler, and the order is left to chance.
#include "TestViewer.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/Renderer>

#include <osg/MatrixTransform>
#include <osg/Texture2D>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

std::atomic<int> milliseconds{0}, frames{0};
std::atomic<bool> stop{false}, stopped{false};

void linger()
{
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    stop = true;
    while (!stopped)
        std::this_thread::yield();
}

osg::ref_ptr<osg::Node> ball(double x, float ior, float roughness)
{
    osg::ref_ptr<osg::MatrixTransform> placed =
        new osg::MatrixTransform(osg::Matrix::translate(x, 0.0, 0.0));
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setIor(ior);
    material->setRoughness(roughness);
    placed->getOrCreateStateSet()->setAttribute(material);
    placed->addChild(sphere(osg::Vec3(), 0.8f, osg::Vec4(0.2f, 0.8f, 0.2f, 1.0f)));
    return placed;
}

/// Replaces children, materials and textures in each frame: this makes conversions, patches and
/// warnings.
void change(osg::Group& group, int frame)
{
    group.removeChildren(0, group.getNumChildren());
    group.addChild(
        ball(-1.0 + 0.1 * (frame % 7), 1.3f + 0.05f * float(frame % 9), 0.1f * float(frame % 5)));
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4 + frame % 3, 4, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::memset(image->data(), 100 + frame % 50, image->getTotalSizeInBytes());
    osg::ref_ptr<osg::Geometry> square = unlitSquare(2.0f, osg::Vec4(1, 1, 1, 1));
    square->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    square->setName("frame " + std::to_string(frame));
    square->setNormalArray(new osg::Vec3Array(4),
                           osg::Array::BIND_PER_VERTEX); // the array is empty: a warning
    group.addChild(square);
    if (frame % 2)
        group.addChild(new AreaLight(osg::Vec3(-1, -1, 3), osg::Vec3(0, 2, 0), osg::Vec3(2, 0, 0),
                                     osg::Vec3(5, 5, 5)));
}

[[noreturn]] void goOn(osg::Group& scene, const std::function<void()>& draw)
{
    while (!stop)
    {
        change(scene, ++frames);
        draw();
    }
    stopped = true;
    for (;;)
        std::this_thread::sleep_for(std::chrono::hours(1));
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 4) return 1;
    const std::string mode = argv[1];
    const int enough = std::atoi(argv[2]);
    milliseconds = std::atoi(argv[3]);
    osg::setNotifyLevel(osg::FATAL);

    osg::ref_ptr<osg::Group> content = new osg::Group;
    change(*content, 0);
    TestViewer view(48, 48, content.get());
    view.frames(2);
    if (milliseconds > 0) std::atexit(linger);
    std::thread(
        [enough]
        {
            while (frames < enough)
                std::this_thread::yield();
            std::exit(0);
        })
        .detach();

    if (mode == "renderer")
    {
        osg::ref_ptr<Renderer> renderer = new Renderer;
        renderer->setScene(content);
        renderer->setSize(48, 48);
        renderer->setViewMatrix(view.camera().getViewMatrix());
        renderer->setProjectionMatrix(view.camera().getProjectionMatrix());
        renderer->getSettings()->setIntegrator(RayTraceSettings::PATH);
        renderer->getSettings()->setMaxPasses(2);
        goOn(*content, [&] { renderer->render(); });
    }
    if (mode != "plain")
    {
        const osg::ref_ptr<RayTracedScene> traced = tracedScene(content.get());
        traced->getSettings()->setIntegrator(RayTraceSettings::AUTOMATIC);
        traced->getSettings()->setPhotons(1000);
        traced->getSettings()->setPresentation(
            mode == "background" ? RayTraceSettings::BACKGROUND : RayTraceSettings::FRAME_LOCKED);
        view.viewer.setSceneData(traced);
    }
    goOn(*content, [&] { view.viewer.frame(); });
}
