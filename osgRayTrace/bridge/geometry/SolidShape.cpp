// SolidShape.cpp - subdivides octahedra. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/SolidShape.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <algorithm>
#include <array>

namespace osgRayTrace::engine
{

namespace
{

constexpr uint32_t kCoarsest = 2, kFinest = 8;
constexpr std::size_t kMostTriangles = std::size_t(1) << 20;

/// Returns the index of a vertex of a hemisphere. Ring k, from the pole on, has 4k vertices; ring n
/// is the equator.
uint32_t ringVertex(uint32_t ring, uint32_t place)
{
    return ring == 0 ? 0 : 1 + 2 * ring * (ring - 1) + place % (4 * ring);
}

/// Returns the directions of a hemisphere around +z.
std::vector<Vec3d> hemisphere(uint32_t n)
{
    constexpr double kCorners[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    std::vector<Vec3d> directions{Vec3d(0.0, 0.0, 1.0)};
    for (uint32_t ring = 1; ring <= n; ++ring)
        for (uint32_t side = 0; side < 4; ++side)
            for (uint32_t place = 0; place < ring; ++place)
            {
                const double rest = ring - place;
                const double* from = kCorners[side];
                const double* to = kCorners[side + 1];
                directions.push_back(
                    glm::normalize(Vec3d(from[0] * rest + to[0] * place,
                                         from[1] * rest + to[1] * place, double(n - ring))));
            }
    return directions;
}

/// Returns the triangles of a hemisphere around +z.
std::vector<UVec3> hemisphereTriangles(uint32_t n)
{
    std::vector<UVec3> triangles;
    for (uint32_t ring = 0; ring < n; ++ring)
        for (uint32_t side = 0; side < 4; ++side)
            for (uint32_t place = 0; place <= ring; ++place)
            {
                const uint32_t here = ringVertex(ring, side * ring + place);
                const uint32_t below = side * (ring + 1) + place;
                triangles.emplace_back(here, ringVertex(ring + 1, below),
                                       ringVertex(ring + 1, below + 1));
                if (place < ring)
                    triangles.emplace_back(here, ringVertex(ring + 1, below + 1),
                                           ringVertex(ring, side * ring + place + 1));
            }
    return triangles;
}

Vec3d mirrored(const Vec3d& direction)
{
    return {direction.x, direction.y, -direction.z};
}

/// A shape of two hemispheres; lower names the mirror image of each vertex of the upper one.
struct Hemispheres
{
    SolidShape shape;
    std::vector<uint32_t> lower;
};

/// Returns the hemispheres of a capsule, which stand apart, or those of a sphere, which share the
/// vertices of the equator.
Hemispheres hemispheresOf(uint32_t n, bool capsule)
{
    const std::vector<Vec3d> directions = hemisphere(n);
    const std::vector<UVec3> upper = hemisphereTriangles(n);
    Hemispheres both;
    SolidShape& shape = both.shape;
    for (const Vec3d& direction : directions)
        shape.vertices.push_back({direction, capsule});
    shape.triangles = upper;
    const uint32_t equator = ringVertex(n, 0);
    for (uint32_t i = 0; i < directions.size(); ++i)
    {
        const bool shared = !capsule && i >= equator;
        both.lower.push_back(shared ? i : static_cast<uint32_t>(shape.vertices.size()));
        if (!shared) shape.vertices.push_back({mirrored(directions[i]), false});
    }
    for (const UVec3& t : upper)
        shape.triangles.emplace_back(both.lower[t.x], both.lower[t.z], both.lower[t.y]);
    return both;
}

SolidShape capsuleOf(uint32_t n)
{
    auto [capsule, lower] = hemispheresOf(n, true);
    for (uint32_t i = 0; i < 4 * n; ++i)
    {
        const uint32_t here = ringVertex(n, i), next = ringVertex(n, i + 1);
        capsule.triangles.emplace_back(lower[here], lower[next], next);
        capsule.triangles.emplace_back(lower[here], next, here);
    }
    return capsule;
}

/// Returns the distance from the centre to the nearest facet.
double inradius(const SolidShape& sphere)
{
    double nearest = 1.0;
    for (const UVec3& t : sphere.triangles)
    {
        const Vec3d a = sphere.vertices[t.x].direction, b = sphere.vertices[t.y].direction,
                    c = sphere.vertices[t.z].direction;
        nearest = std::min(nearest, glm::dot(glm::normalize(glm::cross(b - a, c - a)), a));
    }
    return nearest;
}

SolidShapes shapesOf(uint32_t n)
{
    SolidShapes shapes{hemispheresOf(n, false).shape, capsuleOf(n), 1.0};
    shapes.outset = 2.0 / (1.0 + inradius(shapes.sphere));
    return shapes;
}

} // namespace

const SolidShapes& solidShapes(std::size_t count)
{
    using Levels = std::array<SolidShapes, kFinest - kCoarsest + 1>;
    static const NeverDestroyed<Levels> levels(
        []
        {
            Levels all;
            for (uint32_t n = kCoarsest; n <= kFinest; ++n)
                all[n - kCoarsest] = shapesOf(n);
            return all;
        }());
    uint32_t n = kFinest;
    while (n > kCoarsest && count * 8 * n * n > kMostTriangles)
        --n;
    return (*levels)[n - kCoarsest];
}

} // namespace osgRayTrace::engine
