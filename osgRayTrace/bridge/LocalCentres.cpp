// LocalCentres.cpp - where the vertices of shared geometries are, found without OSG. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/LocalCentres.h"

#include "osgRayTrace/bridge/ArrayReader.h"
#include "osgRayTrace/bridge/VertexArrays.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Local coordinates are moved to their centre if that is so many radii away: else an instance
/// would lose in float what its large coordinates lose.
constexpr double kFarFromOrigin = 64.0;

osg::Vec3d centreOf(const osg::Array& vertices)
{
    Vec3d low(HUGE_VAL), high(-HUGE_VAL);
    const RowSelection all{vertices.getNumElements(), nullptr};
    forEachRow(vertices, all,
               [&](std::size_t, const Vec4d& row)
               {
                   const Vec3d p = row.w == 1.0 ? Vec3d(row) : Vec3d(row) / row.w;
                   if (!std::isfinite(p.x + p.y + p.z)) return;
                   low = glm::min(low, p);
                   high = glm::max(high, p);
               });
    const Vec3d centre = 0.5 * (low + high);
    const bool isFar = glm::length(centre) > kFarFromOrigin * 0.5 * glm::length(high - low);
    if (!isFar || !std::isfinite(glm::dot(centre, centre))) return osg::Vec3d();
    return {centre.x, centre.y, centre.z};
}

} // namespace

void LocalCentres::begin()
{
    _previous = std::move(_current);
    _current.clear();
}

osg::Vec3d LocalCentres::of(const osg::Geometry& geometry)
{
    const osg::Array* vertices = positionArray(geometry);
    if (!isReadable(vertices)) return osg::Vec3d();
    const auto old = _previous.find(&geometry);
    const bool known = old != _previous.end() && old->second.vertices == vertices &&
                       old->second.modified == vertices->getModifiedCount();
    Entry& entry = _current[&geometry];
    entry =
        known ? old->second : Entry{vertices, vertices->getModifiedCount(), centreOf(*vertices)};
    return entry.centre;
}

} // namespace osgRayTrace::engine
