// DrawPass.cpp - reads cameras, viewports and matrices of OSG. Layer: public API.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/DrawPass.h"

#include <osgRayTrace/RayTraceSettings>

#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"

#include <osg/ValueObject>
#include <osg/Viewport>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <algorithm>
#include <cmath>

namespace osgRayTrace
{

namespace
{

/// Returns the user value of a camera as a number, whatever type of number the user set.
std::optional<double> userNumber(const osg::Camera& camera, const char* name)
{
    float single = 0.0f;
    double number = 0.0;
    int whole = 0;
    if (camera.getUserValue(name, number)) return number;
    if (camera.getUserValue(name, single)) return double(single);
    if (camera.getUserValue(name, whole)) return double(whole);
    return {};
}

engine::HostName hostName(const osg::Referenced* object)
{
    return engine::ObjectName(object).hostName();
}

} // namespace

Rectangle currentViewport(const osg::State& state)
{
    const osg::Viewport* viewport = state.getCurrentViewport();
    if (!viewport) return {};
    return {static_cast<int>(viewport->x()), static_cast<int>(viewport->y()),
            static_cast<int>(viewport->width()), static_cast<int>(viewport->height())};
}

engine::PassIdentity passIdentity(osg::RenderInfo& renderInfo, const Rectangle& viewport)
{
    const osg::State& state = *renderInfo.getState();
    const auto& bins = renderInfo.getRenderBinStack();
    engine::PassIdentity pass;
    pass.camera = hostName(renderInfo.getCurrentCamera());
    pass.renderStage = hostName(bins.empty() ? nullptr : bins.back()->getStage());
    pass.contextId = state.getContextID();
    pass.frameNumber = state.getFrameStamp() ? state.getFrameStamp()->getFrameNumber() : 0;
    pass.viewport = {viewport.x, viewport.y, viewport.width, viewport.height};
    pass.view = engine::viewFromMatrices(state.getModelViewMatrix(), state.getProjectionMatrix(),
                                         viewport.width, viewport.height);
    return pass;
}

std::optional<engine::PassIdentity> passIdentity(osgUtil::CullVisitor& visitor)
{
    const osg::Viewport* viewport = visitor.getViewport();
    if (!viewport || !visitor.getModelViewMatrix() || !visitor.getProjectionMatrix() ||
        visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR)
        return std::nullopt;
    engine::PassIdentity pass;
    pass.camera = hostName(visitor.getCurrentCamera());
    pass.renderStage = hostName(visitor.getCurrentRenderStage());
    pass.contextId = visitor.getState() ? visitor.getState()->getContextID() : 0;
    pass.frameNumber = visitor.getFrameStamp() ? visitor.getFrameStamp()->getFrameNumber() : 0;
    pass.view = engine::viewFromMatrices(
        *visitor.getModelViewMatrix(), *visitor.getProjectionMatrix(),
        static_cast<int>(viewport->width()), static_cast<int>(viewport->height()));
    return pass;
}

double nearDistance(const osg::Matrixd& projection)
{
    osg::Matrixd viewFromClip;
    if (!viewFromClip.invert(projection)) return 0.0;
    const bool orthographic = projection(2, 3) == 0.0;
    const osg::Vec3d centre = osg::Vec3d(0.0, 0.0, -1.0) * viewFromClip;
    if (!orthographic) return centre.length();
    return (osg::Vec3d(0.0, 1.0, -1.0) * viewFromClip - centre).length();
}

engine::FrameBudget frameBudget(const osg::Camera* camera, const RayTraceSettings& settings,
                                const std::shared_ptr<engine::FrameAgreement>& agreement)
{
    engine::FrameBudget budget;
    budget.degrade = settings.getDegradeWhileMoving();
    std::optional<double> own;
    if (camera) own = userNumber(*camera, "osgRayTrace.frameBudget");
    const double milliseconds = own.value_or(double(settings.getFrameBudget()));
    budget.seconds = std::isfinite(milliseconds) ? 1e-3 * std::max(0.0, milliseconds) : 0.0;
    const bool agrees =
        settings.getEqualViews() && settings.getPresentation() == RayTraceSettings::FRAME_LOCKED;
    if (agrees && !own && budget.seconds > 0.0) budget.agreement = agreement;
    return budget;
}

} // namespace osgRayTrace
