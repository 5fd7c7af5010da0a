// PointMap.cpp - finds photons around points of media. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PointMap.h"

#include "osgRayTrace/media/PhaseFunction.h"

#include <algorithm>

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

CutBall cutBall(float depth)
{
    const float c = std::min(std::max(depth, 0.0f), 1.0f), c2 = c * c;
    const float m0 = kPi * (2.0f / 3.0f + c - c * c2 / 3.0f);
    const float m1 = kPi * 0.25f * (1.0f - c2) * (1.0f - c2);
    const float m2 = kPi * (2.0f / 15.0f + c * c2 / 3.0f - c * c2 * c2 / 5.0f);
    const float scale = 1.0f / (m0 * m2 - m1 * m1);
    return {m2 * scale, -m1 * scale};
}

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

/// Returns the sum over the photons of the sphere of power times of(cosine) and the kernel.
template <class Scattered> Vec3 PointMap::sumOf(const PointQuery& query, const Scattered& of) const
{
    const float radius2 = query.radius * query.radius;
    const bool isCut = query.depth < query.radius;
    const CutBall kernel = isCut ? cutBall(query.depth / query.radius) : CutBall{1.0f, 0.0f};
    const Vec3 rise = query.inwards * (kernel.slope / query.radius);
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
                        if (!(glm::dot(off, query.inwards) > -query.depth)) continue;
                        if (point.medium != query.medium || point.edges > query.mostEdges) continue;
                        sum += point.power * (of(glm::dot(point.direction, query.towards)) *
                                              (kernel.constant + glm::dot(off, rise)));
                    }
                });
    return sum / ((isCut ? 1.0f : 4.0f / 3.0f * kPi) * radius2 * query.radius);
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
