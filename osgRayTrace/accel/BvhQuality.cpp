// BvhQuality.cpp - areas of boxes around neighbouring triangles. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/BvhQuality.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kGroup = 16;

struct Box
{
    Vec3 low{kInfinity}, high{-kInfinity};

    void add(const Vec3& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    double halfArea() const
    {
        const Vec3d d = Vec3d(high) - Vec3d(low);
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

void add(Box& box, const Mesh& mesh, uint32_t triangle)
{
    const UVec3& t = mesh.triangles[triangle];
    for (int corner = 0; corner < 3; ++corner)
        box.add(mesh.positions[t[corner]]);
}

/// Returns the lowest ten bits of v with two free bits after each.
uint32_t spread(uint32_t v)
{
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

uint32_t mortonCode(const Vec3& centre, const Box& bounds)
{
    uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float size = bounds.high[axis] - bounds.low[axis];
        const float where = size > 0.0f ? (centre[axis] - bounds.low[axis]) / size : 0.0f;
        code |= spread(static_cast<uint32_t>(std::clamp(where, 0.0f, 1.0f) * 1023.0f)) << axis;
    }
    return code;
}

} // namespace

BvhQuality::BvhQuality(const Mesh& mesh)
{
    Box bounds;
    for (const Vec3& p : mesh.positions)
        bounds.add(p);
    std::vector<std::pair<uint32_t, uint32_t>> codes(mesh.triangles.size());
    for (uint32_t i = 0; i < codes.size(); ++i)
    {
        const UVec3& t = mesh.triangles[i];
        const Vec3 centre =
            (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) * (1.0f / 3.0f);
        codes[i] = {mortonCode(centre, bounds), i};
    }
    std::sort(codes.begin(), codes.end());
    _order.reserve(codes.size());
    for (const auto& [code, triangle] : codes)
        _order.push_back(triangle);
    _areaWhenBuilt = groupArea(mesh);
}

double BvhQuality::groupArea(const Mesh& mesh) const
{
    Box all;
    double sum = 0.0;
    for (std::size_t first = 0; first < _order.size(); first += kGroup)
    {
        Box group;
        for (std::size_t i = first; i < std::min(first + kGroup, _order.size()); ++i)
            add(group, mesh, _order[i]);
        sum += group.halfArea();
        all.add(group.low);
        all.add(group.high);
    }
    const double whole = all.halfArea();
    return whole > 0.0 ? sum / whole : 0.0;
}

double BvhQuality::degradation(const Mesh& mesh) const
{
    const double area = groupArea(mesh);
    if (_areaWhenBuilt > 0.0) return area / _areaWhenBuilt;
    return area > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

} // namespace osgRayTrace::engine
