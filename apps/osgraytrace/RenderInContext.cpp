// RenderInContext.cpp - renders like an application with a viewer. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Picture.h"

#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"

#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/offscreen/FrameCapture>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Viewport>
#include <osgViewer/Viewer>

#include <string>

namespace osgRayTrace::app
{

namespace
{

osg::ref_ptr<osg::GraphicsContext> createContext(const Options& options)
{
    const bool osMesa = options.context == Context::OsMesa;
    osg::ref_ptr<osg::GraphicsContext> context =
        osMesa ? createOSMesaContext(options.width, options.height)
               : createEGLContext(options.width, options.height);
    if (context) return context;
    throw Failure(kCannotRender, std::string("no ") + (osMesa ? "OSMesa" : "EGL") + " context of " +
                                     std::to_string(options.width) + "x" +
                                     std::to_string(options.height));
}

/// Returns whether the picture is done. A signal ends the picture with the pass at work: a
/// drawable's passes are not cut short.
bool finished(const Options& options, const Statistics& statistics)
{
    if (isInterrupted()) return true;
    const bool enoughPasses = statistics.passes >= options.settings->getMaxPasses();
    const bool enoughTime = options.seconds > 0.0 && statistics.renderSeconds >= options.seconds;
    return enoughPasses || enoughTime || statistics.relativeError <= options.relativeError;
}

} // namespace

Picture renderInContext(const Options& options, osg::Node& scene, const Camera& camera,
                        Progress& progress)
{
    osg::ref_ptr<RayTracedScene> traced = new RayTracedScene;
    traced->setSettings(options.settings.get());
    options.settings->setFrameBudget(0.0f); // nobody waits for a frame
    traced->addChild(&scene);

    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setSceneData(traced.get());
    osg::ref_ptr<FrameCapture> capture = new FrameCapture;
    osg::Camera* master = viewer.getCamera();
    master->setGraphicsContext(createContext(options).get());
    master->setViewport(0, 0, options.width, options.height);
    master->setClearColor(camera.clearColor);
    // The matrices stay as they are: the rays are those of a render without a context.
    master->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
    master->setViewMatrix(camera.view);
    master->setProjectionMatrix(camera.projection);
    master->setFinalDrawCallback(capture.get());
    viewer.realize();

    Picture picture;
    int passes = -1;
    do
    {
        viewer.frame();
        picture.statistics = traced->getDrawable()->getStatistics();
        if (!picture.statistics.ok) throw Failure(kCannotRender, picture.statistics.message);
        if (picture.statistics.passes == passes)
        {
            throw Failure(kCannotRender,
                          "the context renders no further than pass " + std::to_string(passes));
        }
        passes = picture.statistics.passes;
        progress.show(picture.statistics);
    } while (!finished(options, picture.statistics));

    picture.radiance = traced->getDrawable()->getColorImage();
    picture.display = capture->getColorImage();
    if (!picture.radiance) throw Failure(kCannotRender, "nothing was drawn in the context");
    return picture;
}

} // namespace osgRayTrace::app
