// ReferenceView.h - the view for which levels of detail, billboards and the like are converted.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/CullStack>
#include <osg/Matrixd>
#include <osg/Transform>

#include <memory>
#include <optional>

namespace osgRayTrace::engine
{

/// Holds the one view of a scene that decides on everything that has to be equal in all its views.
struct ReferenceView
{
    osg::Matrixd viewFromWorld;
    osg::Matrixd projection;
    double width = 0.0, height = 0.0; ///< size in pixels
    float lodScale = 1.0f;

    bool operator==(const ReferenceView& other) const
    {
        return viewFromWorld == other.viewFromWorld && projection == other.projection &&
               width == other.width && height == other.height && lodScale == other.lodScale;
    }
};

/// Answers the questions of OSG's nodes to a cull traversal (sizes in pixels, the eye, up), at one
/// place at a time. A stack that followed the traversal would cost each transform a frustum, and
/// most traversals meet no node that asks.
class ReferenceCullStack
{
public:
    explicit ReferenceCullStack(const std::optional<ReferenceView>& view) : _view(view) {}

    /// Returns the cull stack at a place; null without a view. The pointer is valid until the next
    /// call.
    osg::CullStack* at(const osg::Matrixd& worldFromLocal) const;

private:
    std::optional<ReferenceView> _view;
    /// Null: nobody has asked. osg::CullStack is no osg::Referenced.
    mutable std::unique_ptr<osg::CullStack> _stack;
};

/// Returns the transform from eye to world space. Without a view the eye looks along the world's
/// axes.
inline osg::Matrixd worldFromEye(const std::optional<ReferenceView>& view, const osg::Vec3d& eye)
{
    return view ? osg::Matrixd::inverse(view->viewFromWorld) : osg::Matrixd::translate(eye);
}

/// Returns the world matrix below a transform at worldFromOuter. A transform with a frame of its
/// own is in eye space, as in OSG; without a view it is in world space.
osg::Matrixd worldFromLocal(const osg::Transform& node, const osg::Matrixd& worldFromOuter,
                            osg::NodeVisitor& visitor, const std::optional<ReferenceView>& view);

} // namespace osgRayTrace::engine
