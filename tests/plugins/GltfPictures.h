// GltfPictures.h - pictures of small glTF models, and images for their textures. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/plugins/GltfFiles.h"

#include <osgRayTrace/Renderer>

#include <osg/Image>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::test
{

/// Returns the linear picture of a scene that was read with noRotation, from z = 8 along -z.
inline osg::ref_ptr<osg::Image>
pictureOf(osg::Node& scene, RayTraceSettings::Integrator integrator = RayTraceSettings::PATH,
          bool headlight = false)
{
    const osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(&scene);
    renderer->setSize(24, 24);
    renderer->setViewMatrix(
        osg::Matrix::lookAt(osg::Vec3d(0.0, 0.0, 8.0), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0)));
    renderer->setProjectionMatrix(osg::Matrix::perspective(40.0, 1.0, 1.0, 100.0));
    renderer->setHeadlight(headlight);
    renderer->getSettings()->setThreads(1);
    renderer->getSettings()->setMaxPasses(4);
    renderer->getSettings()->setIntegrator(integrator);
    if (!renderer->render()) throw std::runtime_error("the scene is not rendered");
    return new osg::Image(*renderer->getColorImage(), osg::CopyOp::DEEP_COPY_ALL);
}

/// Returns the largest difference of two float pictures of one size, and how bright the first is.
struct Difference
{
    float largest = 0.0f, brightest = 0.0f;
};
inline Difference differenceOf(const osg::Image& a, const osg::Image& b)
{
    Difference difference;
    const auto* x = reinterpret_cast<const float*>(a.data());
    const auto* y = reinterpret_cast<const float*>(b.data());
    for (std::size_t i = 0; i < a.getTotalSizeInBytes() / sizeof(float); ++i)
    {
        if (i % 4 == 3) continue; // alpha
        difference.largest = std::max(difference.largest, std::fabs(x[i] - y[i]));
        difference.brightest = std::max(difference.brightest, x[i]);
    }
    return difference;
}

/// Returns a data URI of a PNG picture of size x size pixels; color(x, y) has three bytes.
template <typename Color> std::string pngOf(int size, const Color& color)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(size, size, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
        {
            const osg::Vec3ub bytes = color(x, y);
            std::copy(bytes.ptr(), bytes.ptr() + 3, image->data(x, y));
        }
    std::ostringstream stream(std::ios::binary);
    osgDB::Registry::instance()->getReaderWriterForExtension("png")->writeImage(*image, stream);
    return "data:image/png;base64," + base64(stream.str());
}

} // namespace osgRayTrace::test
