// MeshClipper.cpp - cuts indexed triangles plane by plane [Sutherland74]. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/MeshClipper.h"

#include <tuple>
#include <unordered_map>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Holds vertex data that can grow.
struct Vertices
{
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs, uvs1;
    std::vector<float> rs, rs1;
    std::vector<Vec4> colors, tangents;
    std::vector<std::vector<Vec2>> moreUvs;
};

template <class T> std::vector<T> copyOf(const SharedArray<T>& values)
{
    return {values.begin(), values.end()};
}

template <class T> void appendBetween(std::vector<T>& values, uint32_t a, uint32_t b, double t)
{
    if (values.empty()) return;
    const auto s = static_cast<float>(t);
    values.push_back(values[a] * (1.0f - s) + values[b] * s);
}

/// Appends an interpolated normal. The sum of opposite normals is zero: the normal of the first
/// corner is then used.
void appendNormal(std::vector<Vec3>& normals, uint32_t a, uint32_t b, double t)
{
    if (normals.empty()) return;
    const Vec3d sum = Vec3d(normals[a]) * (1.0 - t) + Vec3d(normals[b]) * t;
    const double length = glm::length(sum);
    normals.push_back(length > 1e-6 ? Vec3(sum / length) : normals[a]);
}

bool comesBefore(const Vec3& a, const Vec3& b)
{
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

bool hasArea(const std::vector<Vec3>& positions, const UVec3& t)
{
    const Vec3d a(positions[t.x]);
    const Vec3d n = glm::cross(Vec3d(positions[t.y]) - a, Vec3d(positions[t.z]) - a);
    return n != Vec3d(0.0);
}

class PlaneCut
{
public:
    PlaneCut(const Vec4d& plane, Vertices& vertices) : _vertices(vertices)
    {
        _heights.reserve(vertices.positions.size());
        for (const Vec3& p : vertices.positions)
            _heights.push_back(glm::dot(Vec3d(plane), Vec3d(p)) + plane.w);
    }

    std::vector<UVec3> keptOf(const std::vector<UVec3>& triangles)
    {
        std::vector<UVec3> kept;
        kept.reserve(triangles.size());
        for (const UVec3& t : triangles)
            cut(t, kept);
        return kept;
    }

private:
    bool isKept(uint32_t vertex) const { return _heights[vertex] >= 0.0; }

    void cut(const UVec3& t, std::vector<UVec3>& kept)
    {
        const int count = isKept(t.x) + isKept(t.y) + isKept(t.z);
        if (count == 3) kept.push_back(t);
        if (count == 0 || count == 3) return;

        // The triangle is turned so that its first corner is the one that differs from the others.
        const bool differing = count == 1;
        UVec3 u = t;
        while (isKept(u.x) != differing)
            u = UVec3(u.y, u.z, u.x);
        const uint32_t xy = between(u.x, u.y), zx = between(u.z, u.x);
        if (count == 1)
        {
            add(UVec3(u.x, xy, zx), kept);
            return;
        }
        add(UVec3(xy, u.y, u.z), kept);
        add(UVec3(xy, u.z, zx), kept);
    }

    void add(const UVec3& t, std::vector<UVec3>& kept) const
    {
        if (hasArea(_vertices.positions, t)) kept.push_back(t);
    }

    /// Returns the vertex at which the edge meets the plane. Both triangles at the edge share one
    /// vertex, and a neighbour that has copies of the edge's ends gets the same place.
    uint32_t between(uint32_t a, uint32_t b)
    {
        if (comesBefore(_vertices.positions[b], _vertices.positions[a])) std::swap(a, b);
        const auto next = static_cast<uint32_t>(_vertices.positions.size());
        const auto [entry, isNew] = _cuts.try_emplace(uint64_t(a) << 32 | b, next);
        if (!isNew) return entry->second;
        const double t = _heights[a] / (_heights[a] - _heights[b]);
        const Vec3d p(_vertices.positions[a]), q(_vertices.positions[b]);
        _vertices.positions.push_back(Vec3(p + (q - p) * t));
        appendNormal(_vertices.normals, a, b, t);
        appendBetween(_vertices.uvs, a, b, t);
        appendBetween(_vertices.uvs1, a, b, t);
        appendBetween(_vertices.rs, a, b, t);
        appendBetween(_vertices.rs1, a, b, t);
        appendBetween(_vertices.colors, a, b, t);
        appendBetween(_vertices.tangents, a, b, t);
        for (std::vector<Vec2>& uvs : _vertices.moreUvs)
            appendBetween(uvs, a, b, t);
        return next;
    }

    Vertices& _vertices;
    std::vector<double> _heights; // heights of the vertices that were there before the cut
    std::unordered_map<uint64_t, uint32_t> _cuts;
};

} // namespace

void clip(Mesh& mesh, const std::vector<Vec4d>& planes)
{
    Vertices vertices{copyOf(mesh.positions), copyOf(mesh.normals),  copyOf(mesh.uvs),
                      copyOf(mesh.uvs1),      copyOf(mesh.rs),       copyOf(mesh.rs1),
                      copyOf(mesh.colors),    copyOf(mesh.tangents), {}};
    for (const SharedArray<Vec2>& uvs : mesh.moreUvs)
        vertices.moreUvs.push_back(copyOf(uvs));
    std::vector<UVec3> triangles = copyOf(mesh.triangles);
    for (const Vec4d& plane : planes)
        triangles = PlaneCut(plane, vertices).keptOf(triangles);

    // Embree reads past the last position: see Mesh.
    vertices.positions.reserve(vertices.positions.size() + 1);
    mesh.positions = std::move(vertices.positions);
    mesh.normals = std::move(vertices.normals);
    mesh.uvs = std::move(vertices.uvs);
    mesh.uvs1 = std::move(vertices.uvs1);
    mesh.rs = std::move(vertices.rs);
    mesh.rs1 = std::move(vertices.rs1);
    mesh.colors = std::move(vertices.colors);
    mesh.tangents = std::move(vertices.tangents);
    for (std::size_t i = 0; i < mesh.moreUvs.size(); ++i)
        mesh.moreUvs[i] = std::move(vertices.moreUvs[i]);
    mesh.triangles = std::move(triangles);
}

} // namespace osgRayTrace::engine
