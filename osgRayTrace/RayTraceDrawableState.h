// RayTraceDrawableState.h - what a RayTraceDrawable is made of. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceDrawable>

#include "osgRayTrace/ViewPresenter.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"
#include "osgRayTrace/session/view/ViewRegistry.h"

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

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

    /// Returns what read makes of the view drawn last; null, with a warning, if that fails.
    template <typename Read> osg::ref_ptr<osg::Image> imageOfLastView(const Read& read) const
    {
        std::shared_ptr<ViewPresenter> view;
        {
            std::lock_guard<std::mutex> lock(mutex);
            view = lastView;
        }
        if (!view) return nullptr;
        try
        {
            return read(*view);
        }
        catch (const std::exception& error)
        {
            engine::warnOnce(std::string("the view's image could not be made: ") + error.what());
            return nullptr;
        }
    }

    void draw(osg::RenderInfo& renderInfo);
    void recordProgress(const std::shared_ptr<ViewPresenter>& view,
                        const engine::SceneVersion& version);
    void recordNothingSeen(const engine::SceneVersion& version);
    void fail(engine::StatusCode code, const char* message) noexcept;
    void failToDraw(engine::StatusCode code, const char* message) noexcept;
};

} // namespace osgRayTrace
