// main.cpp - osgraytrace: ray traces models to files, without any OpenGL context. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Camera.h"
#include "Options.h"
#include "Output.h"
#include "Picture.h"
#include "Progress.h"
#include "Reference.h"
#include "StatisticsText.h"
#include "apps/common/ErrorMeasures.h"
#include "apps/common/Failure.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/PluginPath.h"

#include <osg/FrameStamp>
#include <osgUtil/UpdateVisitor>

#include <cstdio>
#include <exception>
#include <iostream>
#include <optional>

namespace osgRayTrace::app
{

namespace
{

Picture render(const Options& options, osg::Node& scene)
{
    const Camera camera = cameraOf(options, scene);
    Progress progress(options);
    Picture picture = options.context == Context::None
                          ? renderWithoutContext(options, scene, camera, progress)
                          : renderInContext(options, scene, camera, progress);
    if (picture.statistics.triangles == 0)
        throw Failure(kCannotRender, "the scene holds no triangles to render");
    return picture;
}

/// As osgviewer's first frame: skeletons are posed, clocks are set.
void updateToStart(osg::Node& scene)
{
    const osg::ref_ptr<osg::FrameStamp> start = new osg::FrameStamp;
    osgUtil::UpdateVisitor visitor;
    visitor.setFrameStamp(start);
    scene.accept(visitor);
}

void printMeasures(const ErrorMeasures& measures)
{
    std::printf("RMSE %.6g\nrelMSE %.6g\nmean ratio %.6g\n", measures.rmse, measures.relMse,
                measures.meanRatio);
}

void run(const Options& options)
{
    // What can fail without rendering fails first.
    for (const std::string& output : options.outputs)
    {
        checkWritable(output);
    }
    if (!options.statistics.empty()) checkWritable(options.statistics);
    osg::ref_ptr<osg::Image> reference;
    if (!options.reference.empty())
        reference = readReference(options.reference, options.width, options.height);
    const osg::ref_ptr<osg::Node> scene = readScene(options.models);
    updateToStart(*scene);

    const Picture picture = render(options, *scene);
    std::optional<ErrorMeasures> measures;
    if (reference) measures = errorMeasures(*picture.radiance, *reference);

    for (const std::string& output : options.outputs)
    {
        writePicture(output, picture);
    }
    if (!options.statistics.empty())
    {
        writeText(options.statistics, statisticsJson(options, picture.statistics, measures));
    }
    std::puts(statisticsLine(picture.statistics).c_str());
    if (measures) printMeasures(*measures);
}

} // namespace

} // namespace osgRayTrace::app

int main(int argc, char** argv)
{
    using namespace osgRayTrace::app;
    try
    {
        const std::optional<Options> options = parseOptions(argc, argv);
        if (!options) return kDone;
        if (options->listOptions)
        {
            std::cout << optionTable();
            return kDone;
        }
        addPluginPath();
        run(*options);
        return kDone;
    }
    catch (const Failure& failure)
    {
        std::cerr << "osgraytrace: " << failure.what() << '\n';
        return failure.code();
    }
    catch (const std::exception& error)
    {
        std::cerr << "osgraytrace: " << error.what() << '\n';
        return kCannotRender;
    }
}
