// RayTraceDrawableState.h - what a RayTraceDrawable is made of. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceDrawable>

#include "osgRayTrace/ViewPresenter.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"
#include "osgRayTrace/session/view/ViewRegistry.h"

#include <atomic>
#include <memory>
#include <mutex>

namespace osgRayTrace
{

struct RayTraceDrawable::Implementation
{
    engine::SceneUpdater scene;
    engine::ViewRegistry<ViewPresenter> views;
    std::shared_ptr<engine::FrameAgreement> agreement = std::make_shared<engine::FrameAgreement>();
    std::atomic<bool> paused{false};

    mutable std::mutex mutex;   // draw threads write, any thread reads
    engine::TraceReport report; ///< report of the view drawn last
    std::shared_ptr<ViewPresenter> lastView;
    std::weak_ptr<const engine::TracedScene> untraceable; ///< failed before it gave any image

    void draw(osg::RenderInfo& renderInfo);
    void recordProgress(const std::shared_ptr<ViewPresenter>& view,
                        const engine::SceneVersion& version);
    void fail(engine::StatusCode code, const char* message) noexcept;
    void failToDraw(engine::StatusCode code, const char* message) noexcept;
};

} // namespace osgRayTrace
