// EmissiveMesh.cpp - finds the areas of emitting triangles. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/EmissiveMesh.h"

#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/shading/MeshCorners.h"

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

/// What is known of the triangles of one piece of work.
struct Extent
{
    float largest = 0.0f, largestEdges = 0.0f;
    Vec3 low{kInfinity}, high{-kInfinity};
    std::size_t flat = 0; ///< how many have no area

    void add(const MeshCorners& t)
    {
        largest = std::max(largest, sumAbs(t.a) + sumAbs(t.ab) + sumAbs(t.ac));
        largestEdges = std::max(largestEdges, sumAbs(t.ab) + sumAbs(t.ac));
        low = glm::min(low, glm::min(t.a, glm::min(t.a + t.ab, t.a + t.ac)));
        high = glm::max(high, glm::max(t.a, glm::max(t.a + t.ab, t.a + t.ac)));
    }
    void add(const Extent& o)
    {
        largest = std::max(largest, o.largest);
        largestEdges = std::max(largestEdges, o.largestEdges);
        low = glm::min(low, o.low);
        high = glm::max(high, o.high);
        flat += o.flat;
    }
};

/// Removes triangles without an area from a list of areas, and numbers the others.
void dropFlat(UnclearedArray<double>& areas, std::size_t count, EmissiveAreas& result)
{
    result.indices.assign(count, kInvalid);
    for (std::size_t k = 0; k < count; ++k)
    {
        if (!(areas[k] > 0.0)) continue;
        const std::size_t index = result.primitives.size();
        result.indices[k] = static_cast<uint32_t>(index);
        result.primitives.push_back(static_cast<uint32_t>(k));
        areas[index] = areas[k];
    }
}

} // namespace

std::shared_ptr<const EmissiveAreas> emissiveAreas(const std::shared_ptr<const Mesh>& mesh,
                                                   const MeshPlace& place, const Workers* workers)
{
    const std::size_t count = mesh->triangles.size();
    UnclearedArray<double> sums(count); // first areas, then running sums
    std::vector<Extent> extents((count + kTrianglesAtOnce - 1) / kTrianglesAtOnce);
    const auto measure = [&](std::size_t begin, std::size_t end)
    {
        Extent extent;
        for (std::size_t k = begin; k < end; ++k)
        {
            const MeshCorners t = cornersOf(*mesh, place, k);
            const double area = triangleArea(t.ab, t.ac);
            sums[k] = area;
            if (area > 0.0)
                extent.add(t);
            else
                ++extent.flat;
        }
        extents[begin / kTrianglesAtOnce] = extent;
    };
    forEachPart(workers, count, kTrianglesAtOnce, measure);
    Extent all;
    for (const Extent& e : extents)
        all.add(e);

    auto result = std::make_shared<EmissiveAreas>();
    result->mesh = mesh;
    result->place = place;
    if (all.flat > 0) dropFlat(sums, count, *result);
    const std::size_t kept = count - all.flat;
    double sum = 0.0;
    for (std::size_t k = 0; k < kept; ++k)
        sums[k] = sum += sums[k];
    result->area = sum;
    result->largest = all.largest;
    result->largestEdges = all.largestEdges;
    result->low = all.low;
    result->high = all.high;
    if (!(sum > 0.0)) return result;
    allocateLarge(result->cumulative, kept);
    forEachPart(workers, kept, kTrianglesAtOnce,
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t k = begin; k < end; ++k)
                        result->cumulative[k] = static_cast<float>(sums[k] / sum);
                });
    result->cumulative.back() = 1.0f;
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

void EmissiveMesh::keepTriangles()
{
    if (areas->mesh->triangles.size() >= kLeastLargeMesh) return;
    triangles.reserve(size());
    for (std::size_t k = 0; k < size(); ++k)
        triangles.push_back(computedTriangle(k));
}

EmissiveMesh::Triangle EmissiveMesh::computedTriangle(std::size_t index) const
{
    const Mesh& mesh = *areas->mesh;
    const uint32_t primitive =
        areas->primitives.empty() ? static_cast<uint32_t>(index) : areas->primitives[index];
    const MeshCorners corners = cornersOf(mesh, place, primitive);
    Triangle triangle;
    triangle.a = corners.a;
    triangle.ab = corners.ab;
    triangle.ac = corners.ac;
    triangle.primitive = primitive;
    const SharedArray<Vec2>& uvs = uvsOfSet(mesh, uvSet);
    if (uvs.empty()) return triangle;
    const UVec3& t = mesh.triangles[primitive];
    triangle.ua = uvs[t.x];
    triangle.uab = uvs[t.y] - triangle.ua;
    triangle.uac = uvs[t.z] - triangle.ua;
    return triangle;
}

} // namespace osgRayTrace::engine
