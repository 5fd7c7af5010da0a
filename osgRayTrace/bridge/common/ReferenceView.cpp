// ReferenceView.cpp - a cull stack without a cull traversal. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ReferenceView.h"

#include <osg/Viewport>

namespace osgRayTrace::engine
{

ReferenceCullStack::ReferenceCullStack(const std::optional<ReferenceView>& view)
{
    if (!view) return;
    _viewFromWorld = view->viewFromWorld;
    _stack = std::make_unique<osg::CullStack>();
    _stack->setLODScale(view->lodScale);
    _stack->setCullingMode(osg::CullSettings::NO_CULLING);
    _stack->pushViewport(new osg::Viewport(0.0, 0.0, view->width, view->height));
    _stack->pushProjectionMatrix(new osg::RefMatrix(view->projection));
}

osg::CullStack* ReferenceCullStack::at(const osg::Matrixd& worldFromLocal) const
{
    if (!_stack) return nullptr;
    if (_placed) _stack->popModelViewMatrix();
    _stack->pushModelViewMatrix(new osg::RefMatrix(worldFromLocal * _viewFromWorld),
                                osg::Transform::RELATIVE_RF);
    _placed = true;
    return _stack.get();
}

osg::Matrixd worldFromLocal(const osg::Transform& node, const osg::Matrixd& worldFromOuter,
                            osg::NodeVisitor& visitor, const std::optional<ReferenceView>& view)
{
    osg::Matrixd matrix = worldFromOuter;
    node.computeLocalToWorldMatrix(matrix, &visitor);
    const bool inEyeSpace = node.getReferenceFrame() != osg::Transform::RELATIVE_RF;
    return inEyeSpace && view ? matrix * osg::Matrixd::inverse(view->viewFromWorld) : matrix;
}

} // namespace osgRayTrace::engine
