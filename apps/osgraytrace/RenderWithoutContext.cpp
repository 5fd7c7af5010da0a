// RenderWithoutContext.cpp - renders with osgRayTrace::Renderer. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Picture.h"

#include "CheckpointKeeper.h"
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"

#include <osgRayTrace/Renderer>

namespace osgRayTrace::app
{

namespace
{

/// Lets the passes of a renderer show the scene while the shutter is open.
void openShutter(const Options& options, TimedScene& shown, Renderer& renderer)
{
    renderer.setShutter(
        [&options, &shown, &renderer](double moment)
        {
            Options then = options;
            then.afterFrame = moment * options.shutter;
            then.at = options.at + then.afterFrame;
            shown.clock.goTo(then.at);
            const Camera camera = cameraOf(then, *shown.scene, shown.home);
            renderer.setViewMatrix(camera.view);
            renderer.setProjectionMatrix(croppedProjection(options, camera.projection));
        });
}

/// Sets the images for display: over the clear colour, or over the backdrop of the options.
void setDisplay(const Renderer& renderer, const Options& options, Picture& picture)
{
    const Backdrop& backdrop = options.backdrop;
    if (!backdrop.wanted || backdrop.transparent) picture.display = renderer.getDisplayImage();
    if (!backdrop.wanted) return;
    const osg::ref_ptr<osg::Image> behind =
        backdropImage(backdrop, windowOf(options), options.width, options.height);
    (behind ? picture.display : picture.straight) = renderer.getDisplayImage(behind.get());
    if (behind) return;
    if (!picture.straight) throw Failure(kCannotRender, "no memory for the images");
    makeStraight(*picture.straight);
}

} // namespace

PictureWindow windowOf(const Options& options)
{
    const Crop whole = options.crop.value_or(Crop{0, 0, options.width, options.height});
    return {whole.left, whole.top, whole.fullWidth, whole.fullHeight};
}

osg::ref_ptr<Renderer> newRenderer(const Options& options, TimedScene& shown, const Camera& camera)
{
    osg::ref_ptr<Renderer> renderer = new Renderer;
    renderer->setScene(shown.scene.get());
    renderer->setViewMatrix(camera.view);
    renderer->setProjectionMatrix(camera.projection);
    renderer->setClearColor(camera.clearColor);
    renderer->setHeadlight(options.lights.hasHeadlight());
    renderer->setSize(options.width, options.height);
    renderer->setSettings(options.settings.get());
    renderer->setWholePasses(options.isPart());
    if (options.shutter > 0.0) openShutter(options, shown, *renderer);
    return renderer;
}

Picture pictureOf(const Renderer& renderer, const Options& options)
{
    Picture picture;
    picture.radiance = renderer.getColorImage();
    setDisplay(renderer, options, picture);
    if (!picture.radiance || !picture.display)
        throw Failure(kCannotRender, "no memory for the images");
    picture.statistics = renderer.getStatistics();
    for (const std::string& channel : options.channels)
    {
        const osg::ref_ptr<osg::Image> image = renderer.getChannelImage(channel);
        if (!image) throw Failure(kCannotRender, "no memory for channel " + channel);
        picture.channels[channel] = image;
    }
    return picture;
}

Picture renderWithoutContext(const Options& options, TimedScene& shown, const Camera& camera,
                             Progress& progress)
{
    const osg::ref_ptr<Renderer> renderer = newRenderer(options, shown, camera);
    renderer->setFirstPass(options.firstPass);
    CheckpointKeeper keeper(options, camera.clearColor, *renderer);

    const auto show = [&](const Statistics& statistics)
    {
        progress.show(statistics);
        keeper.keepIfDue();
        return !isInterrupted();
    };
    bool rendered = false;
    {
        // A part of a picture has whole passes, so that the pass at work is finished.
        const OrderlyEnd end(
            [&]
            {
                if (!options.isPart()) renderer->cancel();
            });
        rendered = renderer->render(options.seconds, options.relativeError, show);
    }
    const int kept = rendered ? keeper.keep() : kDone;
    const bool begun = renderer->getStatistics().imageShare > 0.0;
    if (isInterrupted() && !begun)
        throw Failure(interruptionCode(),
                      interruptionName() + ": no part of the picture was rendered yet");
    if (!rendered && !isInterrupted())
        throw Failure(kCannotRender, renderer->getStatistics().message);

    Picture picture = pictureOf(*renderer, options);
    picture.code = kept;
    return picture;
}

} // namespace osgRayTrace::app
