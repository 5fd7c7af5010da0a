// Picks.h - one segment intersected by osgUtil's intersector and by ours, and how the two agree.
// Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayIntersector>
#include <osgRayTrace/RayTracedScene>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace osgRayTrace::test
{

using Segment = osgUtil::LineSegmentIntersector;
using Pick = Segment::Intersection;
using Picks = std::vector<Pick>; ///< in the order of the segment

struct Line
{
    osg::Vec3d start, end;
};

inline Picks picksOf(osg::Node& root, Segment& segment)
{
    osgUtil::IntersectionVisitor visitor(&segment);
    root.accept(visitor);
    return {segment.getIntersections().begin(), segment.getIntersections().end()};
}

inline Picks picksOfOsg(osg::Node& root, const Line& line)
{
    const osg::ref_ptr<Segment> segment = new Segment(line.start, line.end);
    return picksOf(root, *segment);
}

inline Picks
picksByRay(osg::Node& root, const Line& line,
           osgUtil::Intersector::IntersectionLimit limit = osgUtil::Intersector::LIMIT_NEAREST)
{
    const osg::ref_ptr<RayIntersector> ray = new RayIntersector(line.start, line.end);
    ray->setIntersectionLimit(limit);
    return picksOf(root, *ray);
}

/// Tells how our nearest hit of a ray compares with all hits that osgUtil finds.
enum class Relation
{
    Same, ///< osgUtil's nearest hit is the same one, or neither has a hit
    Tie,  ///< osgUtil has this hit and a nearer one, which differ by rounding only
    Other,
};

inline bool isSamePrimitive(const Pick& a, const Pick& b)
{
    return a.nodePath == b.nodePath && a.drawable == b.drawable &&
           a.primitiveIndex == b.primitiveIndex;
}

inline Relation relation(const Picks& ours, const Picks& theirs, double tolerance)
{
    if (ours.empty() || theirs.empty())
        return ours.empty() && theirs.empty() ? Relation::Same : Relation::Other;
    const auto near = [&](const Pick& pick)
    { return std::fabs(pick.ratio - ours.front().ratio) <= tolerance; };
    if (!near(theirs.front())) return Relation::Other;
    if (isSamePrimitive(ours.front(), theirs.front())) return Relation::Same;
    for (const Pick& pick : theirs)
        if (near(pick) && isSamePrimitive(ours.front(), pick)) return Relation::Tie;
    return Relation::Other;
}

inline std::string describe(const Picks& picks)
{
    if (picks.empty()) return "nothing";
    std::ostringstream text;
    const Pick& pick = picks.front();
    text << pick.ratio << " primitive " << pick.primitiveIndex << " of '"
         << pick.drawable->getName() << "' weights";
    for (const double weight : pick.ratioList)
        text << ' ' << weight;
    return text.str();
}

/// Returns whether osgUtil has our hit if the ray is moved by less than rounding in float: the ray
/// then runs along an edge, a seam or the rim of the model.
inline bool isAtAnEdge(osg::Node& root, const Line& line, const Picks& ours, const Picks&,
                       double tolerance)
{
    const osg::Vec3d along = line.end - line.start;
    osg::Vec3d side = along ^ osg::Vec3d(0.36, 0.48, 0.8);
    side.normalize();
    osg::Vec3d up = side ^ along;
    up.normalize();
    const double offset = tolerance * along.length();
    for (int i = 0; i < 8; ++i)
    {
        const double angle = 0.785398163397448 * i;
        const osg::Vec3d shift = (side * std::cos(angle) + up * std::sin(angle)) * offset;
        const Picks shifted = picksOfOsg(root, {line.start + shift, line.end + shift});
        if (relation(ours, shifted, 100.0 * tolerance) != Relation::Other) return true;
    }
    return false;
}

} // namespace osgRayTrace::test
