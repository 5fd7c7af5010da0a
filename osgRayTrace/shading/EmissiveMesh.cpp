// EmissiveMesh.cpp - finds the areas of emitting triangles. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/EmissiveMesh.h"

#include "osgRayTrace/shading/RunningShares.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// A part of this many triangles is one piece of work.
constexpr std::size_t kTrianglesAtOnce = 4096;

float sumAbs(Vec3 v)
{
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

struct Corners
{
    Vec3 a, ab, ac;
};

Corners cornersOf(const Mesh& mesh, const MeshPlace& place, std::size_t primitive)
{
    const UVec3& t = mesh.triangles[primitive];
    Vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (place.placed)
        for (Vec3& q : p)
            q = transformPoint(place.engineFromLocal, q);
    return {p[0], p[1] - p[0], p[2] - p[0]};
}

double areaOf(const Corners& t)
{
    return 0.5 * glm::length(glm::cross(Vec3d(t.ab), Vec3d(t.ac)));
}

/// What is known of the triangles of one piece of work.
struct Extent
{
    float largest = 0.0f, largestEdges = 0.0f;
    Vec3 low{kInfinity}, high{-kInfinity};

    void add(const Corners& t)
    {
        largest = std::max(largest, sumAbs(t.a) + sumAbs(t.ab) + sumAbs(t.ac));
        largestEdges = std::max(largestEdges, sumAbs(t.ab) + sumAbs(t.ac));
        low = glm::min(low, glm::min(t.a, glm::min(t.a + t.ab, t.a + t.ac)));
        high = glm::max(high, glm::max(t.a, glm::max(t.a + t.ab, t.a + t.ac)));
    }
};

} // namespace

std::shared_ptr<const EmissiveAreas> emissiveAreas(const std::shared_ptr<const Mesh>& mesh,
                                                   const MeshPlace& place, const Workers* workers)
{
    const std::size_t count = mesh->triangles.size();
    std::vector<double> areas(count);
    std::vector<Extent> extents((count + kTrianglesAtOnce - 1) / kTrianglesAtOnce);
    const auto measure = [&](std::size_t begin, std::size_t end)
    {
        Extent& extent = extents[begin / kTrianglesAtOnce];
        for (std::size_t k = begin; k < end; ++k)
        {
            const Corners t = cornersOf(*mesh, place, k);
            areas[k] = areaOf(t);
            if (areas[k] > 0.0) extent.add(t);
        }
    };
    forEachPart(workers, count, kTrianglesAtOnce, measure);

    auto result = std::make_shared<EmissiveAreas>();
    result->mesh = mesh;
    result->place = place;
    if (std::any_of(areas.begin(), areas.end(), [](double a) { return !(a > 0.0); }))
    {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k)
        {
            if (!(areas[k] > 0.0)) continue;
            result->primitives.push_back(static_cast<uint32_t>(k));
            areas[kept++] = areas[k];
        }
        areas.resize(kept);
    }
    for (const double area : areas)
        result->area += area;
    Extent all;
    for (const Extent& e : extents)
    {
        all.largest = std::max(all.largest, e.largest);
        all.largestEdges = std::max(all.largestEdges, e.largestEdges);
        all.low = glm::min(all.low, e.low);
        all.high = glm::max(all.high, e.high);
    }
    result->largest = all.largest;
    result->largestEdges = all.largestEdges;
    result->low = all.low;
    result->high = all.high;
    result->cumulative = cumulativeOf(areas);
    return result;
}

float uniformScale(const Mat3& linear)
{
    constexpr float kTolerance = 1e-4f; // of the square of the scale
    const float xx = glm::dot(linear[0], linear[0]), yy = glm::dot(linear[1], linear[1]),
                zz = glm::dot(linear[2], linear[2]);
    const float bound = kTolerance * xx;
    const bool uniform = xx > 0.0f && std::fabs(xx - yy) <= bound && std::fabs(xx - zz) <= bound &&
                         std::fabs(glm::dot(linear[0], linear[1])) <= bound &&
                         std::fabs(glm::dot(linear[1], linear[2])) <= bound &&
                         std::fabs(glm::dot(linear[2], linear[0])) <= bound;
    return uniform ? std::sqrt(xx) : 0.0f;
}

void placeBox(const Affine& place, Vec3& low, Vec3& high)
{
    const Vec3 half = 0.5f * (high - low);
    const Vec3 centre = transformPoint(place, 0.5f * (low + high));
    Vec3 reach(0.0f);
    for (int k = 0; k < 3; ++k)
        reach += glm::abs(place.linear[k]) * half[k];
    low = centre - reach;
    high = centre + reach;
}

double EmissiveMesh::area() const
{
    const double scale = hasLocalAreas() ? uniformScale(place.engineFromLocal.linear) : 1.0;
    return areas->area * scale * scale;
}

float EmissiveMesh::largest() const
{
    if (!hasLocalAreas()) return areas->largest;
    // A turned vector has up to sqrt(3) times the sum of coordinates.
    const float edges =
        std::sqrt(3.0f) * uniformScale(place.engineFromLocal.linear) * areas->largestEdges;
    Vec3 low = areas->low, high = areas->high;
    placeBox(place.engineFromLocal, low, high);
    return sumAbs(glm::max(glm::abs(low), glm::abs(high))) + edges;
}

EmissiveMesh::Triangle EmissiveMesh::triangleOf(uint32_t primitive) const
{
    const Mesh& mesh = *areas->mesh;
    const Corners corners = cornersOf(mesh, place, primitive);
    Triangle triangle;
    triangle.a = corners.a;
    triangle.ab = corners.ab;
    triangle.ac = corners.ac;
    triangle.primitive = primitive;
    triangle.area = static_cast<float>(areaOf(corners));
    const SharedArray<Vec2>& uvs = uvsOfSet(mesh, uvSet);
    if (uvs.empty()) return triangle;
    const UVec3& t = mesh.triangles[primitive];
    triangle.ua = uvs[t.x];
    triangle.uab = uvs[t.y] - triangle.ua;
    triangle.uac = uvs[t.z] - triangle.ua;
    return triangle;
}

} // namespace osgRayTrace::engine
