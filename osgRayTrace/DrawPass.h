// DrawPass.h - what OSG says about the pass that is culled or drawn. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/view/ViewRegistry.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <osg/Camera>
#include <osg/Matrixd>
#include <osg/RenderInfo>
#include <osg/State>

#include <memory>
#include <optional>

namespace osgUtil
{
class CullVisitor;
}

namespace osgRayTrace
{

class RayTraceSettings;

struct Rectangle
{
    int x, y, width, height;
};

/// Returns the viewport in pixels, as osg::Viewport gives it to OpenGL; it has no area if there is
/// none.
Rectangle currentViewport(const osg::State& state);

/// Returns the identity of the pass that is drawn.
engine::PassIdentity passIdentity(osg::RenderInfo& renderInfo, const Rectangle& viewport);

/// Returns the identity of the pass that is culled; nothing if its near and far planes are not
/// known yet.
std::optional<engine::PassIdentity> passIdentity(osgUtil::CullVisitor& visitor);

/// Returns the distance of the near plane in the middle of the view, and 0 if the matrix cannot be
/// inverted. For orthographic views, whose near plane may be anywhere, the result is half the
/// height of the picture.
double nearDistance(const osg::Matrixd& projection);

/// Returns the camera's own budget, or that of the settings, which may be for all views of the
/// agreement.
engine::FrameBudget frameBudget(const osg::Camera* camera, const RayTraceSettings& settings,
                                const std::shared_ptr<engine::FrameAgreement>& agreement);

} // namespace osgRayTrace
