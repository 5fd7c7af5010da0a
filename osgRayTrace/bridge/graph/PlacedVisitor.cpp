// PlacedVisitor.cpp - answers for the eye of a conversion. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/PlacedVisitor.h"

#include "osgRayTrace/bridge/common/FlatMatrix.h"

namespace osgRayTrace::engine
{

namespace
{

/// The unit axes of a transform span at least this volume; a transform with less is singular.
constexpr double kSmallestVolume = 1e-12;

} // namespace

PlacedVisitor::PlacedVisitor(const ConversionInput& input)
    : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN),
      _input(input),
      _worldFromLocal(1),
      _cullStack(input.view)
{
    setTraversalMask(input.traversalMask);
}

osg::Vec3 PlacedVisitor::getEyePoint() const
{
    return _input.eye * osg::Matrixd::inverse(_worldFromLocal.back());
}

float PlacedVisitor::getDistanceToEyePoint(const osg::Vec3& position, bool useLodScale) const
{
    const float scale = useLodScale && _input.view ? _input.view->lodScale : 1.0f;
    return (position - getEyePoint()).length() * scale;
}

float PlacedVisitor::getDistanceFromEyePoint(const osg::Vec3& position, bool) const
{
    return static_cast<float>(
        (osg::Vec3d(position) * _worldFromLocal.back() - _input.eye).length());
}

float PlacedVisitor::getDistanceToViewPoint(const osg::Vec3& position, bool useLodScale) const
{
    return getDistanceToEyePoint(position, useLodScale);
}

const char* PlacedVisitor::enterPlace(const osg::Matrixd& worldFromLocal)
{
    const std::optional<osg::Matrixd> place = placingMatrix(worldFromLocal, kSmallestVolume);
    if (!place) return matrixFault(worldFromLocal, kSmallestVolume);
    _worldFromLocal.push_back(*place);
    return nullptr;
}

osg::Matrixd PlacedVisitor::worldBelow(const osg::Transform& node)
{
    return worldFromLocal(node, _worldFromLocal.back(), *this, _input.view);
}

} // namespace osgRayTrace::engine
