// ViewPresenter.h - the image of a view, and how it comes to the display. Layer: public API.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/DisplayTexture.h"
#include "osgRayTrace/bridge/update/SceneVersion.h"
#include "osgRayTrace/session/view/BackgroundTracer.h"

#include <osg/Image>
#include <osg/RenderInfo>

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgRayTrace
{

/// Describes one pass of a view in a frame.
struct ViewFrame
{
    const engine::SceneVersion& version; ///< holds a scene
    engine::View pass;
    std::vector<engine::View> slices; ///< all slices of the pass's picture: see ViewRegistry
    bool shared = false;              ///< true: another slice of this frame has drawn
    engine::FrameBudget budget;
    bool paused = false;
};

/// Frame-locked, draw traces the view of its pass and shows that. In the background draw asks the
/// view's worker for an image, and shows the newest that there is, of whatever view that was asked
/// for; before the first image it draws nothing. Both go on with the same accumulated image, so the
/// presentation may change from frame to frame. Draw thread of the view's context, unless stated
/// otherwise.
class ViewPresenter
{
public:
    ViewPresenter();

    /// Brings the display up to date. Throws std::bad_alloc, std::system_error.
    void update(const ViewFrame& frame);

    /// Draws the display's image. Returns false, and draws nothing, if the context has no usable
    /// GLSL.
    bool draw(osg::RenderInfo& renderInfo, const engine::View& pass);

    /// Lets go of the image, of what it was traced of, and of the worker. The display shows nothing
    /// until the next update() has an image.
    void forget();

    /// Returns the report of the last update().
    engine::TraceReport report(const engine::SceneVersion& version);
    bool inBackground() const { return _inBackground; } ///< any thread

    /// Lets views that could not be traced until now be tried again. May be called from any thread.
    void forgetFailures() { _tracer.forgetFailures(); }

    /// Linear radiance as it is accumulated; null if there is none. Any thread; waits for
    /// whoever traces.
    osg::ref_ptr<osg::Image> radiance() const;

    /// Returns a channel of that image, in the format of Renderer::getChannelImage; null if there
    /// is none. Threads as above.
    osg::ref_ptr<osg::Image> channel(engine::Channel channel) const;

    /// Releases OpenGL's objects in any thread that OSG calls it from; null: of all contexts.
    void releaseGLObjects(osg::State* state) const { _display.releaseGLObjects(state); }
    void resizeGLObjectBuffers(unsigned int maxSize) { _display.resizeGLObjectBuffers(maxSize); }

private:
    std::optional<engine::View> viewToTrace(const ViewFrame& frame);
    void traceNow(const ViewFrame& frame);
    void askWorker(const ViewFrame& frame);
    void showNewest();

    engine::BackgroundTracer _tracer;
    DisplayTexture _display;
    std::vector<engine::View> _slices; ///< slices that are asked for
    std::vector<engine::View>
        _presentedSlices; ///< slices of the passes for which the display's image was traced
    std::atomic<bool> _inBackground{false};
    bool _holds = false;         ///< whether there may be something to forget
    bool _traced = false;        ///< in this frame, by draw
    uint64_t _frames = 0;        ///< frames that the view has drawn
    engine::TracedImage _newest; ///< image that the display shows in the background
};

} // namespace osgRayTrace
