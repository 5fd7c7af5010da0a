// ViewPresenter.cpp - traces or asks for a view's image, and displays it. Layer: public API.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/ViewPresenter.h"

#include "osgRayTrace/bridge/common/PixelImage.h"

#include <OpenThreads/Thread>

#include <algorithm>
#include <utility>

namespace osgRayTrace
{

namespace
{

/// Values of traced pixels as OSG wants them.
class PixelsImage : public osg::Image
{
public:
    PixelsImage(std::shared_ptr<engine::TracedPixels> pixels, GLenum format, GLenum type,
                unsigned char* values)
        : _pixels(std::move(pixels))
    {
        setImage(_pixels->width, _pixels->height, 1, static_cast<GLint>(format), format, type,
                 values, NO_DELETE);
    }

private:
    std::shared_ptr<engine::TracedPixels> _pixels;
};

/// A worker does not keep to the processor of the thread that starts it: osgViewer binds the
/// threads that draw.
void leaveProcessor()
{
    OpenThreads::SetProcessorAffinityOfCurrentThread(OpenThreads::Affinity());
}

} // namespace

ViewPresenter::ViewPresenter() : _tracer({}, leaveProcessor) {}

/// Returns the view that has to be traced for a pass; nothing if another slice of its picture has
/// been traced.
std::optional<engine::View> ViewPresenter::viewToTrace(const ViewFrame& frame)
{
    const engine::View& pass = frame.pass;
    const bool moved = _slices.empty() || !engine::sameRays(_slices.front(), pass);
    if (!frame.shared || moved)
    {
        _slices = frame.slices;
        return _slices.size() == 1 ? pass : engine::viewOfSlices(_slices);
    }
    const bool sliced = _slices.size() > 1;
    const engine::View last = sliced ? engine::viewOfSlices(_slices) : _slices.front();
    _slices.insert(_slices.end(), frame.slices.begin(), frame.slices.end());
    const engine::View needed = engine::viewOfSlices(_slices);
    if (sliced && needed == last) return std::nullopt;
    return needed;
}

void ViewPresenter::update(const ViewFrame& frame)
{
    _holds = true;
    if (!frame.shared) ++_frames;
    if (frame.version.settings->getPresentation() == RayTraceSettings::BACKGROUND)
        askWorker(frame);
    else
        traceNow(frame);
}

void ViewPresenter::forget()
{
    if (!std::exchange(_holds, false)) return;
    _tracer.forget();
    _display.clear();
    _slices.clear();
    _presentedSlices.clear();
    _newest = engine::TracedImage();
    _inBackground = _traced = false;
}

void ViewPresenter::traceNow(const ViewFrame& frame)
{
    if (_inBackground) _tracer.stop();
    const auto tracer = _tracer.lease();
    if (_inBackground) tracer->forgetDisplay();
    _inBackground = false;

    std::optional<engine::View> wanted;
    if (!frame.paused || !tracer->hasImage()) wanted = viewToTrace(frame);
    _traced = wanted.has_value();
    if (wanted)
    {
        // The tracer writes to the display at once, unless the size changes: the display then shows
        // the last image until there is a new one.
        const bool fits = _display.width() == wanted->width && _display.height() == wanted->height;
        if (tracer->trace(frame.version.inputs, *wanted, frame.budget,
                          fits ? _display.rgba() : nullptr, fits ? _display.depth() : nullptr))
            _display.modified(tracer->changed());
    }
    if (tracer->needsResolve(frame.version.inputs))
    {
        const int width = tracer->displayWidth(), height = tracer->displayHeight();
        _display.resize(width, height, width == frame.pass.width && height == frame.pass.height);
        _display.reserve(frame.pass.width, frame.pass.height);
        tracer->resolve(_display.rgba(), _display.depth());
        _display.modified();
    }
    _presentedSlices = _slices;
}

void ViewPresenter::askWorker(const ViewFrame& frame)
{
    _inBackground = true;
    _traced = false;
    const bool waits = frame.paused && _display.width() > 0;
    std::optional<engine::View> wanted;
    if (!waits)
        wanted = viewToTrace(frame);
    else if (!frame.shared)
        wanted = frame.pass;
    if (wanted)
        _tracer.ask({frame.version.inputs, *wanted, _slices, frame.budget, !waits}, _frames);
    // All slices of a frame show one image.
    if (frame.shared || !_tracer.takeNewest(_newest)) return;
    showNewest();
    _presentedSlices = _newest.slices;
}

/// Without a copy: the images of the display hold the pixels while it has them.
void ViewPresenter::showNewest()
{
    const std::shared_ptr<engine::TracedPixels>& pixels = _newest.pixels;
    const osg::ref_ptr<osg::Image> color =
        new PixelsImage(pixels, GL_RGBA, GL_UNSIGNED_BYTE, pixels->rgba.data());
    const osg::ref_ptr<osg::Image> depth = new PixelsImage(
        pixels, GL_LUMINANCE, GL_FLOAT, reinterpret_cast<unsigned char*>(pixels->depth.data()));
    _display.show(color.get(), depth.get());
}

bool ViewPresenter::draw(osg::RenderInfo& renderInfo, const engine::View& pass)
{
    const engine::DepthMap depths = _presentedSlices.size() > 1
                                        ? engine::depthMap(pass, _presentedSlices)
                                        : engine::depthMap(pass);
    const bool drawn = _display.width() == 0 || _display.draw(renderInfo, depths);
    if (_traced) _tracer.lease()->recordPresented();
    return drawn;
}

engine::TraceReport ViewPresenter::report(const engine::SceneVersion& version)
{
    if (_inBackground) return _tracer.report(_frames);
    const auto tracer = _tracer.lease();
    return {tracer->progress(), tracer->frame(), version.inputs.scene, true, 0};
}

osg::ref_ptr<osg::Image> ViewPresenter::radiance() const
{
    const auto tracer = _tracer.lease();
    if (!tracer->hasImage()) return nullptr;
    const std::vector<float> radiance = tracer->radiance();
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(tracer->width(), tracer->height(), 1, GL_RGBA, GL_FLOAT);
    std::copy(radiance.begin(), radiance.end(), reinterpret_cast<float*>(image->data()));
    return image;
}

osg::ref_ptr<osg::Image> ViewPresenter::channel(engine::Channel channel) const
{
    const auto tracer = _tracer.lease();
    if (!tracer->hasImage()) return nullptr;
    const GLenum format = engine::channelSize(channel) == 1 ? GL_LUMINANCE : GL_RGB;
    return engine::pixelImage(tracer->channel(channel), tracer->width(), tracer->height(), format);
}

} // namespace osgRayTrace
