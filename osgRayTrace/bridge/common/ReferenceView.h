// ReferenceView.h - the view that levels of detail, billboards and the like are converted for.
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

/// One of the views of a scene: that of all which has to be the same in all of them.
struct ReferenceView
{
    osg::Matrixd viewFromWorld;
    osg::Matrixd projection;
    double width = 0.0, height = 0.0; ///< pixels
    float lodScale = 1.0f;

    bool operator==(const ReferenceView& other) const
    {
        return viewFromWorld == other.viewFromWorld && projection == other.projection &&
               width == other.width && height == other.height && lodScale == other.lodScale;
    }
};

/// Answers what OSG's nodes ask a cull traversal (sizes in pixels, the eye, up), at one place at a
/// time: a stack that followed the traversal would cost each transform a frustum.
class ReferenceCullStack
{
public:
    explicit ReferenceCullStack(const std::optional<ReferenceView>& view);

    /// Null without a view. Valid until the next call.
    osg::CullStack* at(const osg::Matrixd& worldFromLocal) const;

private:
    osg::Matrixd _viewFromWorld;
    std::unique_ptr<osg::CullStack> _stack; // an osg::Referenced nowhere
    mutable bool _placed = false;
};

/// World matrix below a transform at worldFromOuter. A transform with a frame of its own is in eye
/// space, as OSG has it; without a view, in world space.
osg::Matrixd worldFromLocal(const osg::Transform& node, const osg::Matrixd& worldFromOuter,
                            osg::NodeVisitor& visitor, const std::optional<ReferenceView>& view);

} // namespace osgRayTrace::engine
