// Outline.cpp - sorts vertices into a grid, and places its boxes. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Outline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kMostAlongAxis = 4;
constexpr std::size_t kTrianglesPerCell = 16;

/// The limit above which a mesh is not parted: vertices that no triangle has are looked at, too,
/// and a mesh may be a small part of large arrays.
constexpr std::size_t kMostVertices = 3; ///< [vertices per triangle]

/// The rounding error of a bound, relative to the magnitudes that are added up: four of their last
/// bits.
constexpr float kRounding = 0x1p-22f;

std::size_t cellsAlongAxis(const Mesh& mesh)
{
    const std::size_t triangles = mesh.triangles.size();
    if (mesh.positions.size() > kMostVertices * triangles) return 1;
    std::size_t n = 1;
    while (n < kMostAlongAxis && (n + 1) * (n + 1) * (n + 1) * kTrianglesPerCell <= triangles)
        ++n;
    return n;
}

bool contains(const Box& box, const Vec3& p)
{
    return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x &&
           p.y <= box.high.y && p.z <= box.high.z;
}

/// Returns boxes whose hulls hold the triangles: a triangle is in the hull of the boxes of its
/// vertices. The vertices of triangles are all in bounds, and a vertex outside belongs to no
/// triangle.
std::vector<Box> boxesOf(const Mesh& mesh, const Box& bounds)
{
    const std::size_t n = cellsAlongAxis(mesh);
    if (n == 1) return {};
    std::array<Box, kMostAlongAxis * kMostAlongAxis * kMostAlongAxis> cells;
    Vec3 scale(0.0f);
    for (int axis = 0; axis < 3; ++axis)
    {
        const float size = bounds.high[axis] - bounds.low[axis];
        const float cellsPerLength = static_cast<float>(n) / size;
        if (size < kInfinity && cellsPerLength < kInfinity) scale[axis] = cellsPerLength;
    }
    for (const Vec3& p : mesh.positions)
    {
        if (!contains(bounds, p)) continue;
        const auto cellAlong = [&](int axis)
        {
            const float where = std::min((p[axis] - bounds.low[axis]) * scale[axis], 1e3f);
            return std::min(static_cast<std::size_t>(where), n - 1);
        };
        Box& cell = cells[cellAlong(0) + n * (cellAlong(1) + n * cellAlong(2))];
        cell.low = glm::min(cell.low, p);
        cell.high = glm::max(cell.high, p);
    }
    std::vector<Box> boxes;
    for (const Box& cell : cells)
        if (cell.low.x <= cell.high.x) boxes.push_back(cell);
    return boxes;
}

/// Returns whether the transform keeps axes along axes, mirrored or not: parts are then not bounded
/// more closely than the whole mesh.
bool keepsAxes(const Mat3& linear)
{
    for (int row = 0; row < 3; ++row)
    {
        const int zeros =
            (linear[0][row] == 0.0f) + (linear[1][row] == 0.0f) + (linear[2][row] == 0.0f);
        if (zeros < 2) return false;
    }
    return true;
}

} // namespace

Outline::Outline(const Mesh& mesh, const Box& bounds) : _whole(bounds)
{
    const std::vector<Box> boxes = boxesOf(mesh, bounds);
    _parts.resize((boxes.size() + kLanes - 1) / kLanes);
    for (std::size_t i = 0; i < _parts.size() * kLanes; ++i)
    {
        const Box& box = boxes[std::min(i, boxes.size() - 1)];
        const Vec3 half = 0.5f * box.high - 0.5f * box.low, centre = box.low + half;
        Boxes& lanes = _parts[i / kLanes];
        const int lane = static_cast<int>(i % kLanes);
        lanes.centre.x[lane] = centre.x;
        lanes.centre.y[lane] = centre.y;
        lanes.centre.z[lane] = centre.z;
        lanes.half.x[lane] = half.x;
        lanes.half.y[lane] = half.y;
        lanes.half.z[lane] = half.z;
    }
}

Outline::Outline(const Box& bounds) : _whole(bounds) {}

/// Extends low to high lane by lane by the placed parts.
OSGRAYTRACE_KERNEL
void Outline::extend(const std::vector<Boxes>& parts, const Affine& m, Vec3Lanes& low,
                     Vec3Lanes& high)
{
    for (int row = 0; row < 3; ++row)
    {
        const float x = m.linear[0][row], y = m.linear[1][row], z = m.linear[2][row];
        const float sizeX = std::fabs(x), sizeY = std::fabs(y), sizeZ = std::fabs(z);
        const float shift = m.translation[row];
        FloatLanes& from = row == 0 ? low.x : row == 1 ? low.y : low.z;
        FloatLanes& to = row == 0 ? high.x : row == 1 ? high.y : high.z;
        for (const Boxes& b : parts)
        {
            OSGRAYTRACE_SIMD
            for (int i = 0; i < kLanes; ++i)
            {
                const float middle =
                    x * b.centre.x[i] + y * b.centre.y[i] + z * b.centre.z[i] + shift;
                const float reach = sizeX * b.half.x[i] + sizeY * b.half.y[i] + sizeZ * b.half.z[i];
                from[i] = middle - reach < from[i] ? middle - reach : from[i];
                to[i] = middle + reach > to[i] ? middle + reach : to[i];
            }
        }
    }
}

Box Outline::placedBounds(const Affine& m) const
{
    const auto absolute = [&m](const Vec3& v) {
        return glm::abs(m.linear[0]) * v.x + glm::abs(m.linear[1]) * v.y +
               glm::abs(m.linear[2]) * v.z;
    };
    const Vec3 farthest = glm::max(glm::abs(_whole.low), glm::abs(_whole.high));
    const Vec3 rounding = kRounding * (absolute(farthest) + glm::abs(m.translation));
    if (_parts.empty() || keepsAxes(m.linear))
    {
        const Vec3 half = 0.5f * _whole.high - 0.5f * _whole.low;
        const Vec3 middle = transformPoint(m, _whole.low + half), reach = absolute(half);
        return {middle - reach - rounding, middle + reach + rounding};
    }
    Vec3Lanes low, high;
    for (FloatLanes* lanes : {&low.x, &low.y, &low.z})
        std::fill_n(lanes->v, kLanes, kInfinity);
    for (FloatLanes* lanes : {&high.x, &high.y, &high.z})
        std::fill_n(lanes->v, kLanes, -kInfinity);
    extend(_parts, m, low, high);
    const auto least = [](const FloatLanes& l) { return *std::min_element(l.v, l.v + kLanes); };
    const auto most = [](const FloatLanes& l) { return *std::max_element(l.v, l.v + kLanes); };
    return {Vec3(least(low.x), least(low.y), least(low.z)) - rounding,
            Vec3(most(high.x), most(high.y), most(high.z)) + rounding};
}

} // namespace osgRayTrace::engine
