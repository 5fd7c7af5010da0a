// stereo.cpp - shows what two eyes see through one screen, side by side, with off-axis frusta.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTracedScene>

#include <osg/ShapeDrawable>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

// All lengths are in metres. The distance is that of the head from the screen.
constexpr double kHalfWidth = 0.25, kHalfHeight = 0.1875, kDistance = 0.6, kHalfEyes = 0.0325;

// This callback places an eye at x beside the head, which is the viewer's own camera.
struct Eye : osg::View::Slave::UpdateSlaveCallback
{
    explicit Eye(double position) : x(position) {}
    void updateSlave(osg::View& view, osg::View::Slave& slave) override
    {
        const osg::Matrix head = view.getCamera()->getViewMatrix();
        slave._camera->setViewMatrix(head * osg::Matrix::translate(-x, 0, 0));
        // The frustum leads through the edges of the screen; OpenSceneGraph fits its depth later.
        slave._camera->setProjectionMatrixAsFrustum(-kHalfWidth - x, kHalfWidth - x, -kHalfHeight,
                                                    kHalfHeight, kDistance, 100.0);
    }
    double x;
};

int main()
{
    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->getSettings()->setEqualViews(true); // both eyes get the same passes and resolution
    // The red ball stands before the screen, the green one in its plane y = 0, the blue one behind.
    for (int i = 0; i < 3; ++i)
    {
        osg::ref_ptr<osg::ShapeDrawable> ball = new osg::ShapeDrawable;
        ball->setShape(new osg::Sphere({0.08f * (i - 1), 0.2f * (i - 1), 0}, 0.03f));
        ball->setColor(osg::Vec4(i == 0, i == 1, i == 2, 1));
        scene->addChild(ball);
    }
    scene->addChild(osg::createTexturedQuadGeometry({-1, -1, -0.1f}, {2, 0, 0}, {0, 2, 0}));

    // Two slave cameras share the window; the viewer's own camera is the head and draws nothing.
    osgViewer::Viewer viewer;
    viewer.setUpViewInWindow(50, 50, 1280, 480);
    osg::ref_ptr<osg::GraphicsContext> window = viewer.getCamera()->getGraphicsContext();
    viewer.getCamera()->setGraphicsContext(nullptr);
    for (const int side : {0, 1})
    {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setGraphicsContext(window);
        camera->setViewport(side * 640, 0, 640, 480);
        viewer.addSlave(camera);
        viewer.getSlave(side)._updateSlaveCallback = new Eye(side == 0 ? -kHalfEyes : kHalfEyes);
    }
    osg::ref_ptr<osgGA::TrackballManipulator> trackball = new osgGA::TrackballManipulator;
    trackball->setHomePosition({0, -kDistance, 0}, {0, 0, 0}, {0, 0, 1});
    viewer.setCameraManipulator(trackball);
    viewer.setLightingMode(osg::View::SKY_LIGHT); // a sky light casts shadows, a headlight none
    viewer.setSceneData(scene);
    return viewer.run();
}
