// RayTraceDrawableState.cpp - traces the view of a pass and shows it. Layer: public API, private.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/RayTraceDrawableState.h"

#include "osgRayTrace/DrawPass.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/session/view/DepthSlices.h"

#include <utility>

namespace osgRayTrace
{

void RayTraceDrawable::Implementation::draw(osg::RenderInfo& renderInfo)
{
    const osg::State& state = *renderInfo.getState();
    const Rectangle viewport = currentViewport(state);
    if (viewport.width <= 0 || viewport.height <= 0) return;
    const engine::SceneVersion version = scene.version();
    if (!version.inputs.scene) return;

    const auto makeView = [] { return std::make_shared<ViewPresenter>(); };
    const engine::PassIdentity pass = passIdentity(renderInfo, viewport);
    const engine::ViewRegistry<ViewPresenter>::Pass found = views.acquire(pass, makeView);
    ViewPresenter& view = *found.state;
    engine::FrameBudget budget =
        frameBudget(renderInfo.getCurrentCamera(), *version.settings, agreement);
    budget.frameNumber = pass.frameNumber;
    budget.again = found.shared;
    scene.recordDrawn(renderInfo.getCurrentCamera(),
                      osg::Matrixd::inverse(state.getModelViewMatrix()).getTrans(),
                      nearDistance(state.getProjectionMatrix()));
    if (!version.seen && budget.seconds > 0.0 && !paused)
    {
        view.forget();
        return recordNothingSeen(version);
    }
    view.update({version, pass.view, found.slices, found.shared, budget, paused});
    const bool drawn = view.draw(renderInfo, pass.view);
    recordProgress(found.state, version);
    if (!drawn)
        fail(engine::StatusCode::DeviceFailure, "OpenGL cannot compile the display's shaders");
}

/// Records that a picture without anything in it is complete: nothing is traced for it, and nothing
/// drawn. There is no image of it either.
void RayTraceDrawable::Implementation::recordNothingSeen(const engine::SceneVersion& version)
{
    engine::TraceReport nothing;
    nothing.scene = version.inputs.scene;
    nothing.progress.passes = version.inputs.maxPasses;
    nothing.progress.imageShare = 1.0;
    nothing.progress.error = {0.0, 0.0, 0.0};
    std::shared_ptr<ViewPresenter> last; // freed without the lock
    std::lock_guard<std::mutex> lock(mutex);
    report = std::move(nothing);
    lastView.swap(last);
}

void RayTraceDrawable::Implementation::recordProgress(const std::shared_ptr<ViewPresenter>& view,
                                                      const engine::SceneVersion& version)
{
    engine::TraceReport result = view->report(version);
    const engine::Status& status = result.progress.status;
    if (!status.ok() && status.code != engine::StatusCode::EmptyScene)
        engine::warnOnce(status.message);
    const bool failed = status.code == engine::StatusCode::OutOfMemory ||
                        status.code == engine::StatusCode::DeviceFailure;

    std::lock_guard<std::mutex> lock(mutex);
    if (failed && result.fresh && result.progress.passes == 0) untraceable = result.scene;
    report = std::move(result);
    lastView = view;
}

void RayTraceDrawable::Implementation::fail(engine::StatusCode code, const char* message) noexcept
{
    std::lock_guard<std::mutex> lock(mutex);
    engine::Status& status = report.progress.status;
    status = engine::failure(code, message);
    engine::warnOnce(status.message);
}

/// Sets a status of a pass that drew nothing: the children take its place.
void RayTraceDrawable::Implementation::failToDraw(engine::StatusCode code,
                                                  const char* message) noexcept
{
    fail(code, message);
    const engine::SceneVersion version = scene.version();
    std::lock_guard<std::mutex> lock(mutex);
    untraceable = version.inputs.scene;
}

} // namespace osgRayTrace
