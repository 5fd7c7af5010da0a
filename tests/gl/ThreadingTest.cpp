// ThreadingTest.cpp - all of osgViewer's threading models, several contexts. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/MatrixTransform>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);
constexpr int kSize = 48;

osg::ref_ptr<FrameCapture> addCamera(osgViewer::Viewer& viewer, const osg::Matrixd& viewOffset)
{
    osg::ref_ptr<osg::GraphicsContext> context = createOSMesaContext(kSize, kSize);
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    osg::ref_ptr<FrameCapture> capture = new FrameCapture;
    camera->setGraphicsContext(context.get());
    camera->setViewport(0, 0, kSize, kSize);
    camera->addFinalDrawCallback(capture.get());
    viewer.addSlave(camera.get(), osg::Matrixd(), viewOffset);
    return capture;
}

} // namespace

TEST_CASE("threading: 50 frames of a moving scene in three contexts", "[gl]")
{
    const auto model = GENERATE(osgViewer::ViewerBase::SingleThreaded,
                                osgViewer::ViewerBase::CullDrawThreadPerContext,
                                osgViewer::ViewerBase::DrawThreadPerContext,
                                osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext);
    osg::ref_ptr<osg::MatrixTransform> moving = new osg::MatrixTransform;
    moving->setDataVariance(osg::Object::DYNAMIC);
    moving->addChild(unlitSquare(1.0f, kGreen));
    osg::ref_ptr<RayTracedScene> scene = tracedScene(moving.get());
    scene->addChild(sphere(osg::Vec3(0.0f, 0.0f, -3.0f), 0.5f, osg::Vec4(1, 1, 1, 1)));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);

    osgViewer::Viewer viewer;
    viewer.getCamera()->setProjectionMatrixAsPerspective(40.0, 1.0, 1.0, 100.0);
    viewer.getCamera()->setViewMatrixAsLookAt(osg::Vec3d(0, 0, 10), osg::Vec3d(),
                                              osg::Vec3d(0, 1, 0));
    const osg::ref_ptr<FrameCapture> captures[] = {
        addCamera(viewer, osg::Matrixd()), addCamera(viewer, osg::Matrixd::rotate(0.1, 0, 1, 0)),
        addCamera(viewer, osg::Matrixd::rotate(-0.1, 0, 1, 0))};
    viewer.setThreadingModel(model);
    viewer.setSceneData(root.get());
    viewer.realize();
    for (int i = 0; i < 50; ++i)
    {
        moving->setMatrix(osg::Matrix::translate(i % 2 ? 0.0 : 50.0, 0.0, 0.0));
        if (i == 20) scene->setEnabled(false);
        if (i == 30) scene->setEnabled(true);
        viewer.frame();
    }
    const bool traced = scene->getDrawable()->getStatistics().ok;
    viewer.stopThreading();

    CHECK(traced);
    for (const osg::ref_ptr<FrameCapture>& capture : captures)
    {
        int green = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x)
                green += pixel(*capture->getColorImage(), x, y) == osg::Vec4(0, 255, 0, 255);
        CHECK(green > 50);
    }
    CHECK(scene->getDrawable()->getStatistics().passes >= 1);
}
