// RenderedRoom.h - a small room with soft shadows, and a renderer of it. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/Renderer>

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>

#include <cstring>

namespace osgRayTrace::test
{

inline osg::ref_ptr<osg::Geode> quad(const osg::Vec3& corner, const osg::Vec3& u,
                                     const osg::Vec3& v)
{
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(osg::createTexturedQuadGeometry(corner, u, v));
    geode->getOrCreateStateSet()->setAttribute(new osg::Material);
    return geode;
}

/// A floor below a smaller roof, and a lamp between them: soft shadows and noise.
inline osg::ref_ptr<osg::Group> room()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(quad(osg::Vec3(-2.0f, -2.0f, 0.0f), osg::Vec3(4.0f, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 4.0f, 0.0f)));
    group->addChild(quad(osg::Vec3(-1.0f, -1.0f, 1.0f), osg::Vec3(1.0f, 0.0f, 0.0f),
                         osg::Vec3(0.0f, 1.0f, 0.0f)));
    group->addChild(new AreaLight(osg::Vec3(-0.5f, -0.5f, 2.0f), osg::Vec3(0.0f, 1.0f, 0.0f),
                                  osg::Vec3(1.0f, 0.0f, 0.0f), osg::Vec3(5.0f, 5.0f, 5.0f)));
    return group;
}

/// 48 x 32 pixels of the room from above and in front, two threads, four passes.
inline osg::ref_ptr<Renderer> rendererOf(osg::Node* scene)
{
    osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(scene);
    renderer->setSize(48, 32);
    renderer->setViewMatrix(osg::Matrix::lookAt(
        osg::Vec3d(0.0, -6.0, 3.0), osg::Vec3d(0.0, 0.0, 0.5), osg::Vec3d(0.0, 0.0, 1.0)));
    renderer->setProjectionMatrix(osg::Matrix::perspective(45.0, 1.5, 1.0, 100.0));
    renderer->getSettings()->setThreads(2);
    renderer->getSettings()->setMaxPasses(4);
    renderer->getSettings()->setIntegrator(RayTraceSettings::PATH);
    return renderer;
}

inline bool sameBytes(const osg::Image* a, const osg::Image* b)
{
    return a && b && a->getTotalSizeInBytes() == b->getTotalSizeInBytes() &&
           std::memcmp(a->data(), b->data(), a->getTotalSizeInBytes()) == 0;
}

inline const float* floats(const osg::Image& image)
{
    return reinterpret_cast<const float*>(image.data());
}

} // namespace osgRayTrace::test
