// viewer.cpp - shows a model ray traced in a window, with the mouse and keys of osgviewer.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTracedScene>

#include <osgDB/ReadFile>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <iostream>

int main(int argc, char** argv)
{
    osg::ref_ptr<osg::Node> model = argc == 2 ? osgDB::readRefNodeFile(argv[1]) : nullptr;
    if (!model)
    {
        std::cerr << "Usage: viewer MODEL\n";
        return 1;
    }

    // Everything below this node is ray traced. The model itself stays as it is.
    osg::ref_ptr<osgRayTrace::RayTracedScene> scene = new osgRayTrace::RayTracedScene;
    scene->addChild(model);

    // Path tracing computes indirect light, too. Without this line, the materials and lights of the
    // model decide: fixed-function ones are shown with direct light, shadows and mirrors alone.
    scene->getSettings()->setIntegrator(osgRayTrace::RayTraceSettings::PATH);

    // The viewer needs no changes. While the camera rests, the picture converges from frame to
    // frame; while it moves, the resolution is reduced to keep the frame rate.
    osgViewer::Viewer viewer;
    viewer.setSceneData(scene);
    viewer.addEventHandler(new osgViewer::StatsHandler); // the key s shows the frame rate
    return viewer.run();
}
