// RayIntersector.cpp - the constructors, which set the limit to one hit. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayIntersector>

namespace osgRayTrace
{

RayIntersector::RayIntersector(const osg::Vec3d& start, const osg::Vec3d& end)
    : osgUtil::LineSegmentIntersector(start, end)
{
    setIntersectionLimit(LIMIT_NEAREST);
}

RayIntersector::RayIntersector(CoordinateFrame frame, const osg::Vec3d& start,
                               const osg::Vec3d& end)
    : osgUtil::LineSegmentIntersector(frame, start, end, nullptr, LIMIT_NEAREST)
{
}

RayIntersector::RayIntersector(CoordinateFrame frame, double x, double y)
    : osgUtil::LineSegmentIntersector(frame, x, y)
{
    setIntersectionLimit(LIMIT_NEAREST);
}

RayIntersector::~RayIntersector() = default;

} // namespace osgRayTrace
