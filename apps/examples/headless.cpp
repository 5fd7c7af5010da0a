// headless.cpp - renders a model to a PNG and an EXR file, without a window, a display or a GPU.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Renderer>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <iostream>
#include <string>

int main(int argc, char** argv)
{
    osg::ref_ptr<osg::Node> model = argc == 3 ? osgDB::readRefNodeFile(argv[1]) : nullptr;
    if (!model)
    {
        std::cerr << "Usage: headless MODEL NAME   writes NAME.png and NAME.exr\n";
        return 1;
    }
    const std::string name = argv[2];

    // A Renderer takes a scene graph as it is; there is no viewer, and no OpenGL context.
    osg::ref_ptr<osgRayTrace::Renderer> renderer = new osgRayTrace::Renderer;
    renderer->setScene(model);
    renderer->setSize(640, 480);
    renderer->setHomeView(); // osgviewer opens with this view; setViewMatrix sets another

    // Rendering stops after a time in seconds (0: no limit) or at an estimated error, here 2 %.
    renderer->getSettings()->setIntegrator(osgRayTrace::RayTraceSettings::PATH);
    if (!renderer->render(0.0, 0.02))
    {
        std::cerr << "Cannot render: " << renderer->getStatistics().message << '\n';
        return 1;
    }
    const osgRayTrace::Statistics& statistics = renderer->getStatistics();
    std::cout << statistics.passes << " passes in " << statistics.renderSeconds
              << " s, estimated error " << 100.0 * statistics.relativeError << " %, "
              << 100.0 * statistics.medianError << " % in the median tile\n";

    // The display image is tone mapped, in 8 bits. The colour image holds linear radiance in floats
    // for further processing; the EXR plugin comes with osgRayTrace.
    const bool written = osgDB::writeImageFile(*renderer->getDisplayImage(), name + ".png") &&
                         osgDB::writeImageFile(*renderer->getColorImage(), name + ".exr");
    return written ? 0 : 1;
}
