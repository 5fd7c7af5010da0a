// TestViewer.h - a viewer in an OSMesa context, and functions that examine its pictures. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/offscreen/FrameCapture>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Geometry>
#include <osg/ShapeDrawable>
#include <osgViewer/Viewer>

#include <cmath>
#include <cstring>

namespace osgRayTrace::test
{

/// Whether a sanitizer is on: sanitizers find their errors in fewer pictures.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// Holds a viewer with one thread, without a manipulator, with fixed near and far planes unless a
/// test changes them, and with a black background.
struct TestViewer
{
    TestViewer(int width, int height, osg::Node* scene,
               osg::ref_ptr<osg::GraphicsContext> context = nullptr)
        : capture(new FrameCapture)
    {
        viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
        osg::Camera& camera = *viewer.getCamera();
        camera.setGraphicsContext(context ? context.get()
                                          : createOSMesaContext(width, height).get());
        camera.setViewport(0, 0, width, height);
        camera.setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        camera.addFinalDrawCallback(capture.get());
        camera.setProjectionMatrixAsPerspective(40.0, double(width) / height, 1.0, 100.0);
        look(osg::Vec3d(0.0, 0.0, 10.0));
        viewer.setSceneData(scene);
    }

    osg::Camera& camera() { return *viewer.getCamera(); }

    void look(const osg::Vec3d& eye, const osg::Vec3d& center = osg::Vec3d(),
              const osg::Vec3d& up = osg::Vec3d(0.0, 1.0, 0.0))
    {
        viewer.getCamera()->setViewMatrixAsLookAt(eye, center, up);
    }

    /// Draws this many frames and returns a copy of the last picture.
    osg::ref_ptr<osg::Image> frames(int count = 1)
    {
        if (!viewer.isRealized()) viewer.realize();
        for (int i = 0; i < count; ++i)
            viewer.frame();
        return new osg::Image(*capture->getColorImage(), osg::CopyOp::DEEP_COPY_ALL);
    }

    float depth(int x, int y) const
    {
        return *reinterpret_cast<const float*>(capture->getDepthImage()->data(x, y));
    }

    osgViewer::Viewer viewer;
    osg::ref_ptr<FrameCapture> capture;
};

inline osg::Vec4 pixel(const osg::Image& image, int x, int y)
{
    const unsigned char* p = image.data(x, y);
    return osg::Vec4(p[0], p[1], p[2], p[3]);
}

inline bool equal(const osg::Image& a, const osg::Image& b)
{
    return a.s() == b.s() && a.t() == b.t() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

/// Returns the mean absolute difference of RGB, 0 to 255, over the pixels for which use(x, y) is
/// true.
template <class Use> double meanDifference(const osg::Image& a, const osg::Image& b, const Use& use)
{
    double sum = 0.0;
    long count = 0;
    for (int y = 0; y < a.t(); ++y)
        for (int x = 0; x < a.s(); ++x)
        {
            if (!use(x, y)) continue;
            for (int c = 0; c < 3; ++c)
                sum += std::abs(int(a.data(x, y)[c]) - int(b.data(x, y)[c]));
            count += 3;
        }
    return count ? sum / count : 0.0;
}

inline double meanDifference(const osg::Image& a, const osg::Image& b)
{
    return meanDifference(a, b, [](int, int) { return true; });
}

/// Returns the means of samples * samples pixels each: a traced picture is antialiased, so a
/// picture that it is compared with must be, too.
inline osg::ref_ptr<osg::Image> reduced(const osg::Image& image, int samples)
{
    osg::ref_ptr<osg::Image> small = new osg::Image;
    small->allocateImage(image.s() / samples, image.t() / samples, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < small->t(); ++y)
        for (int x = 0; x < small->s(); ++x)
        {
            osg::Vec4 sum;
            for (int i = 0; i < samples * samples; ++i)
                sum += pixel(image, x * samples + i % samples, y * samples + i / samples);
            for (int c = 0; c < 4; ++c)
                small->data(x, y)[c] =
                    static_cast<unsigned char>(sum[c] / float(samples * samples) + 0.5f);
        }
    return small;
}

/// Returns an unlit square of side 2*half in the plane z = 0, which faces +z and has one colour.
inline osg::ref_ptr<osg::Geometry> unlitSquare(float half, const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> square = osg::createTexturedQuadGeometry(
        osg::Vec3(-half, -half, 0.0f), osg::Vec3(2.0f * half, 0.0f, 0.0f),
        osg::Vec3(0.0f, 2.0f * half, 0.0f));
    square->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
    square->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return square;
}

inline osg::ref_ptr<osg::ShapeDrawable> sphere(const osg::Vec3& center, float radius,
                                               const osg::Vec4& color)
{
    osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
    hints->setDetailRatio(4.0f);
    osg::ref_ptr<osg::ShapeDrawable> drawable =
        new osg::ShapeDrawable(new osg::Sphere(center, radius), hints.get());
    drawable->setColor(color);
    return drawable;
}

/// Returns a scene whose settings do not depend on the tester's environment, and whose pictures do
/// not depend on the speed of the machine.
inline osg::ref_ptr<RayTracedScene> tracedScene(osg::Node* child)
{
    osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->getSettings()->setIntegrator(RayTraceSettings::WHITTED);
    scene->getSettings()->setShadows(false);
    scene->getSettings()->setFrameBudget(0.0f);
    if (child) scene->addChild(child);
    return scene;
}

} // namespace osgRayTrace::test
