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

CutBall cutBall(float depth, float beyond)
{
    // The integrals of u^k pi (1 - u^2) from -a to b.
    const double a = std::min(std::max(double(depth), 0.0), 1.0), a2 = a * a;
    const double b = std::min(std::max(double(beyond), 1e-6), 1.0), b2 = b * b;
    const double pi = double(kPi);
    const double m0 = pi * (b - b * b2 / 3.0 + a - a * a2 / 3.0);
    const double m1 = pi * 0.25 * ((2.0 - b2) * b2 - (2.0 - a2) * a2);
    const double m2 = pi * (b * b2 / 3.0 - b * b2 * b2 / 5.0 + a * a2 / 3.0 - a * a2 * a2 / 5.0);
    const double scale = 1.0 / (m0 * m2 - m1 * m1);
    return {static_cast<float>(m2 * scale), static_cast<float>(-m1 * scale)};
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
    const CutBall kernel = isCut ? cutBall(query.depth / query.radius, query.beyond / query.radius)
                                 : CutBall{1.0f, 0.0f};
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
                        const float along = glm::dot(off, query.inwards);
                        if (!(along > -query.depth && along < query.beyond)) continue;
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
