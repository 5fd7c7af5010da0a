// RenderInContext.cpp - renders like an application with a viewer. Layer: apps.
// SPDX-License-Identifier: MIT
#include "DrawnLayer.h"
#include "Particles.h"
#include "Picture.h"

#include "apps/common/DrawnParts.h"
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"

#include <osgRayTrace/RayTracedScene>
#include <osgRayTrace/offscreen/FrameCapture>
#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Viewport>
#include <osgViewer/Viewer>

#include <cstdint>
#include <cstdlib>
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
                                     std::to_string(options.height) +
                                     "; --context none needs none");
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

/// Draws a frame at a time of the simulation [s]. The clock counts for nothing, so that pictures do
/// not depend on how long they take.
void drawFrame(osgViewer::Viewer& viewer, double time)
{
    viewer.advance(time);
    viewer.getFrameStamp()->setReferenceTime(time);
    viewer.updateTraversal();
    viewer.renderingTraversals();
}

/// Particles are emitted in the frames before a picture, as they are in a viewer. Frames are drawn
/// from five seconds before time 0 on; they are small, as nobody sees them. 0.03 does not divide 1:
/// -1 means "no time yet" to osgParticle.
constexpr double kParticleStep = 0.03; ///< [s]
constexpr int kParticleFrames = 167;   ///< before time 0

void emitParticles(osgViewer::Viewer& viewer, RayTraceDrawable& drawable, const Options& options)
{
    std::srand(options.settings->getSeed()); // osgParticle takes its random numbers from std::rand
    drawable.setPaused(true);
    osg::Camera& camera = *viewer.getCamera();
    camera.setViewport(0, 0, (options.width + 15) / 16, (options.height + 15) / 16);
    for (int frame = -kParticleFrames; frame * kParticleStep < options.at && !isInterrupted();
         ++frame)
        drawFrame(viewer, frame * kParticleStep);
    camera.setViewport(0, 0, options.width, options.height);
    drawable.setPaused(false);
}

/// Draws frames until the picture is done, and returns its statistics.
Statistics accumulate(const Options& options, osgViewer::Viewer& viewer,
                      const RayTraceDrawable& drawable, Progress& progress)
{
    Statistics statistics;
    int passes = -1;
    do
    {
        drawFrame(viewer, options.at);
        statistics = drawable.getStatistics();
        if (!statistics.ok) throw Failure(kCannotRender, statistics.message);
        if (statistics.passes == passes)
        {
            throw Failure(kCannotRender,
                          "the context renders no further than pass " + std::to_string(passes));
        }
        passes = statistics.passes;
        progress.show(statistics);
    } while (!finished(options, statistics));
    return statistics;
}

/// Without a light the view would switch GL_LIGHTING off for the whole scene.
void darken(osg::Light& light)
{
    const osg::Vec4 black(0.0f, 0.0f, 0.0f, 1.0f);
    light.setAmbient(black);
    light.setDiffuse(black);
    light.setSpecular(black);
}

void setUp(osgViewer::Viewer& viewer, const Options& options, RayTracedScene& traced,
           const Camera& camera)
{
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setSceneData(&traced);
    if (!options.lights.hasHeadlight()) darken(*viewer.getLight());
    osg::Camera* master = viewer.getCamera();
    master->setGraphicsContext(createContext(options).get());
    master->setViewport(0, 0, options.width, options.height);
    osg::Vec4 clearColor = camera.clearColor;
    if (options.backdrop.wanted) clearColor.a() = 0.0f; // it stands for the backdrop
    master->setClearColor(clearColor);
    // The matrices stay as they are: the rays are those of a render without a context.
    master->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
    master->setViewMatrix(camera.view);
    master->setProjectionMatrix(camera.projection);
    viewer.realize();
}

} // namespace

Picture renderInContext(const Options& options, osg::Node& scene, const Camera& camera,
                        Progress& progress)
{
    osg::ref_ptr<RayTracedScene> traced = new RayTracedScene;
    traced->setSettings(options.settings.get());
    options.settings->setFrameBudget(0.0f); // nobody waits for a frame
    traced->addChild(&scene);
    RayTraceDrawable& drawable = *traced->getDrawable();
    osgViewer::Viewer viewer;
    setUp(viewer, options, *traced, camera);

    if (hasParticles(scene)) emitParticles(viewer, drawable, options);
    Picture picture;
    picture.statistics = accumulate(options, viewer, drawable, progress);
    picture.radiance = drawable.getColorImage();
    for (const std::string& channel : options.channels)
        picture.channels[channel] = drawable.getChannelImage(channel);

    osg::ref_ptr<FrameCapture> capture = new FrameCapture;
    viewer.getCamera()->setFinalDrawCallback(capture.get());
    drawable.setPaused(true);
    const auto draw = [&] { drawFrame(viewer, options.at); };
    draw();
    if (!picture.radiance || !capture->getColorImage()->data())
        throw Failure(kCannotRender, "nothing was drawn in the context");
    picture.display = new osg::Image(*capture->getColorImage(), osg::CopyOp::DEEP_COPY_ALL);
    if (partsDrawnByOsg(picture.statistics) > 0)
        compositeDrawnParts({viewer, *traced, scene, *capture, draw}, camera, *options.settings,
                            picture);
    return picture;
}

} // namespace osgRayTrace::app
