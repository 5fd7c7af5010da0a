// PointMap.cpp - finds photons around points of media. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PointMap.h"

#include "osgRayTrace/media/PhaseFunction.h"

namespace osgRayTrace::engine
{

namespace
{

/// Returns the boxes of a node that may hold points within a radius.
OSGRAYTRACE_KERNEL
LaneMask nodesAround(const BoxTree::Node& node, PlainVec3 centre, float radius)
{
    LaneMask near = 0;
    OSGRAYTRACE_SIMD_OR(near)
    for (int i = 0; i < kLanes; ++i)
    {
        const PlainVec3 off = plainOf(node.centre, i) - centre;
        const float reach = radius + node.radius[i];
        near |=
            bitOfLane(maskOf(dot(off, off) <= reach * reach) & maskOf(node.radius[i] >= 0.0f), i);
    }
    return near;
}

} // namespace

PointMap::PointMap(const std::vector<PhotonPoint>& points)
{
    std::vector<ItemBox> boxes;
    boxes.reserve(points.size());
    for (const PhotonPoint& point : points)
        boxes.push_back({point.position, point.position});
    std::vector<uint32_t> order;
    _tree = BoxTree(boxes, order);
    _points.reserve(points.size());
    for (const uint32_t k : order)
        _points.push_back(points[k]);
}

/// Returns the sum over the photons of the sphere of power times of(cosine), over its volume.
template <class Scattered> Vec3 PointMap::sumOf(const PointQuery& query, const Scattered& of) const
{
    const float radius2 = query.radius * query.radius;
    Vec3 sum(0.0f);
    _tree.visit([&](const BoxTree::Node& node)
                { return nodesAround(node, plainOf(query.position), query.radius); },
                [&](std::size_t first, std::size_t count)
                {
                    for (std::size_t k = first; k < first + count; ++k)
                    {
                        const PhotonPoint& point = _points[k];
                        const Vec3 off = point.position - query.position;
                        if (!(glm::dot(off, off) < radius2)) continue;
                        if (point.medium != query.medium || point.edges > query.mostEdges) continue;
                        sum += point.power * of(glm::dot(point.direction, query.towards));
                    }
                });
    return sum / (4.0f / 3.0f * kPi * radius2 * query.radius);
}

Vec3 PointMap::gather(const PointQuery& query) const
{
    return sumOf(query, [&](float cosTheta) { return evalPhase(query.phase, cosTheta); });
}

Vec3 PointMap::gather(const PointQuery& query, const Scatterers& here) const
{
    return sumOf(query, [&](float cosTheta) { return here.scattered(cosTheta); });
}

} // namespace osgRayTrace::engine
