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

/// Vertices that no triangle has are looked at, too: a mesh may be a small part of large arrays.
constexpr std::size_t kMostVertices = 3; ///< for each triangle

/// Of the magnitudes that are added up for a bound; four of their last bits.
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

/// A triangle is in the hull of the boxes of its vertices. All of these are in bounds: what is not
/// belongs to no triangle.
std::vector<Box> boxesOf(const Mesh& mesh, const Box& bounds)
{
    const std::size_t n = cellsAlongAxis(mesh);
    if (n == 1) return {bounds};
    std::array<Box, kMostAlongAxis * kMostAlongAxis * kMostAlongAxis> cells;
    Vec3 scale(0.0f);
    for (int axis = 0; axis < 3; ++axis)
    {
        const float size = bounds.high[axis] - bounds.low[axis];
        if (size > 0.0f && size < kInfinity) scale[axis] = static_cast<float>(n) / size;
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

/// Extends the range of one coordinate of placed boxes, lane by lane: x, y, z and shift are the
/// row of their transform.
OSGRAYTRACE_KERNEL
void extendRange(const Vec3Lanes& centre, const Vec3Lanes& half, float x, float y, float z,
                 float shift, FloatLanes& low, FloatLanes& high)
{
    const float sizeX = std::fabs(x), sizeY = std::fabs(y), sizeZ = std::fabs(z);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float middle = x * centre.x[i] + y * centre.y[i] + z * centre.z[i] + shift;
        const float reach = sizeX * half.x[i] + sizeY * half.y[i] + sizeZ * half.z[i];
        const float from = middle - reach, to = middle + reach;
        low[i] = from < low[i] ? from : low[i];
        high[i] = to > high[i] ? to : high[i];
    }
}

} // namespace

Outline::Outline(const Mesh& mesh, const Box& bounds)
{
    const std::vector<Box> boxes = boxesOf(mesh, bounds);
    _boxes.resize((boxes.size() + kLanes - 1) / kLanes);
    for (std::size_t i = 0; i < _boxes.size() * kLanes; ++i)
    {
        const Box& box = boxes[std::min(i, boxes.size() - 1)];
        const Vec3 half = 0.5f * box.high - 0.5f * box.low, centre = box.low + half;
        Boxes& lanes = _boxes[i / kLanes];
        const int lane = static_cast<int>(i % kLanes);
        lanes.centre.x[lane] = centre.x;
        lanes.centre.y[lane] = centre.y;
        lanes.centre.z[lane] = centre.z;
        lanes.half.x[lane] = half.x;
        lanes.half.y[lane] = half.y;
        lanes.half.z[lane] = half.z;
    }
    _farthest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
}

Outline::Outline(const Box& bounds) : Outline(Mesh(), bounds) {}

Box Outline::placedBounds(const Affine& m) const
{
    Box placed;
    for (int row = 0; row < 3; ++row)
    {
        const float x = m.linear[0][row], y = m.linear[1][row], z = m.linear[2][row];
        FloatLanes low, high;
        std::fill_n(low.v, kLanes, kInfinity);
        std::fill_n(high.v, kLanes, -kInfinity);
        for (const Boxes& boxes : _boxes)
            extendRange(boxes.centre, boxes.half, x, y, z, m.translation[row], low, high);
        const float rounding =
            kRounding * (std::fabs(x) * _farthest.x + std::fabs(y) * _farthest.y +
                         std::fabs(z) * _farthest.z + std::fabs(m.translation[row]));
        placed.low[row] = *std::min_element(low.v, low.v + kLanes) - rounding;
        placed.high[row] = *std::max_element(high.v, high.v + kLanes) + rounding;
    }
    return placed;
}

} // namespace osgRayTrace::engine
