// PolygonTriangles.cpp - cuts off ears of a polygon until a triangle is left. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/PolygonTriangles.h"

#include <cmath>
#include <cstdint>
#include <numeric>

namespace osgRayTrace::engine
{

namespace
{

/// Returns twice the area of the polygon times the unit normal of its plane, or of the plane
/// nearest to it.
Vec3d areaNormal(const std::vector<Vec3d>& corners)
{
    Vec3d sum(0.0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return sum;
}

/// Holds the remaining outline, seen along the normal.
class Outline
{
public:
    Outline(const std::vector<Vec3d>& corners, const Vec3d& normal)
        : _corners(corners), _normal(normal), _left(corners.size())
    {
        std::iota(_left.begin(), _left.end(), 0u);
    }

    std::size_t size() const { return _left.size(); }

    UVec3 triangleAt(std::size_t i) const
    {
        const std::size_t n = _left.size();
        return {_left[(i + n - 1) % n], _left[i], _left[(i + 1) % n]};
    }

    /// Returns whether a corner sticks out and its triangle covers no other corner: without the ear
    /// the rest is still a polygon.
    bool isEar(std::size_t i) const
    {
        const UVec3 ear = triangleAt(i);
        if (!(side(ear.x, ear.y, ear.z) > 0.0)) return false;
        for (const uint32_t p : _left)
        {
            if (p == ear.x || p == ear.y || p == ear.z || isAnyOf(ear, p)) continue;
            if (side(ear.x, ear.y, p) >= 0.0 && side(ear.y, ear.z, p) >= 0.0 &&
                side(ear.z, ear.x, p) >= 0.0)
                return false;
        }
        return true;
    }

    /// Returns whether a corner's triangle has no area and so covers nothing.
    bool isFlat(std::size_t i) const
    {
        const UVec3 t = triangleAt(i);
        return side(t.x, t.y, t.z) == 0.0;
    }

    void cut(std::size_t i) { _left.erase(_left.begin() + static_cast<std::ptrdiff_t>(i)); }

private:
    double side(uint32_t a, uint32_t b, uint32_t c) const
    {
        return glm::dot(_normal, glm::cross(_corners[b] - _corners[a], _corners[c] - _corners[a]));
    }

    /// Returns whether a corner is at the place of one of the triangle's: outlines that lead to a
    /// hole and back meet their own corners.
    bool isAnyOf(const UVec3& t, uint32_t p) const
    {
        return _corners[p] == _corners[t.x] || _corners[p] == _corners[t.y] ||
               _corners[p] == _corners[t.z];
    }

    const std::vector<Vec3d>& _corners;
    Vec3d _normal;
    std::vector<uint32_t> _left;
};

/// Returns whether no triangle of the fan is turned over; then no two of them overlap.
bool isFanRight(const std::vector<Vec3d>& corners, const Vec3d& normal)
{
    for (std::size_t i = 2; i < corners.size(); ++i)
    {
        const Vec3d n = glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
        if (glm::dot(n, normal) < 0.0) return false;
    }
    return true;
}

} // namespace

std::vector<UVec3> concavePolygonTriangles(const std::vector<Vec3d>& corners)
{
    if (corners.size() < 4 || corners.size() > kMostCorners) return {};
    const Vec3d sum = areaNormal(corners);
    const double length = glm::length(sum);
    if (!(length > 0.0) || !std::isfinite(length)) return {};
    const Vec3d normal = sum / length;
    if (isFanRight(corners, normal)) return {};

    std::vector<UVec3> triangles;
    Outline outline(corners, normal);
    std::size_t i = 0, sinceCut = 0;
    while (outline.size() > 3)
    {
        if (outline.isFlat(i) || outline.isEar(i))
        {
            triangles.push_back(outline.triangleAt(i));
            outline.cut(i);
            i = i > 0 ? i - 1 : 0;
            sinceCut = 0;
            continue;
        }
        if (++sinceCut > outline.size()) return {}; // the outline cuts itself
        i = (i + 1) % outline.size();
    }
    triangles.push_back(outline.triangleAt(1));
    return triangles;
}

} // namespace osgRayTrace::engine
