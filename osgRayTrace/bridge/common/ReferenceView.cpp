// ReferenceView.cpp - a cull stack without a cull traversal. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ReferenceView.h"

#include <osg/Viewport>

namespace osgRayTrace::engine
{

namespace
{

std::unique_ptr<osg::CullStack> cullStackOf(const ReferenceView& view)
{
    auto stack = std::make_unique<osg::CullStack>();
    stack->setLODScale(view.lodScale);
    stack->setCullingMode(osg::CullSettings::NO_CULLING);
    stack->pushViewport(new osg::Viewport(0.0, 0.0, view.width, view.height));
    stack->pushProjectionMatrix(new osg::RefMatrix(view.projection));
    return stack;
}

} // namespace

osg::CullStack* ReferenceCullStack::at(const osg::Matrixd& worldFromLocal) const
{
    if (!_view) return nullptr;
    if (_stack)
        _stack->popModelViewMatrix();
    else
        _stack = cullStackOf(*_view);
    _stack->pushModelViewMatrix(new osg::RefMatrix(worldFromLocal * _view->viewFromWorld),
                                osg::Transform::RELATIVE_RF);
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
