// offscreen.cpp - an OSG application in memory with the installed package, whose scene is ray
// traced.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/offscreen/FrameCapture>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/ShapeDrawable>
#include <osgViewer/Viewer>

#include <iostream>

int main()
{
    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->addChild(new osg::ShapeDrawable(new osg::Sphere));

    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setSceneData(scene);
    osg::Camera* camera = viewer.getCamera();
    camera->setGraphicsContext(osgRayTrace::createOSMesaContext(64, 64));
    camera->setViewport(0, 0, 64, 64);
    camera->setClearColor(osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f));
    camera->setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 20.0);
    camera->setViewMatrixAsLookAt(osg::Vec3d(0, -6, 0), osg::Vec3d(), osg::Vec3d(0, 0, 1));
    osg::ref_ptr<osgRayTrace::FrameCapture> capture = new osgRayTrace::FrameCapture;
    camera->setFinalDrawCallback(capture);
    viewer.frame();

    const osg::Vec4 centre = capture->getColorImage()->getColor(32u, 32u);
    const osg::Vec4 corner = capture->getColorImage()->getColor(0u, 0u);
    std::cout << "centre " << centre.r() << ", corner " << corner.r() << '\n';
    return centre.r() > 0.3f && corner == osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f) ? 0 : 1;
}
