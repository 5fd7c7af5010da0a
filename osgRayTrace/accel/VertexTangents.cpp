// VertexTangents.cpp - means of triangles' tangents at shared vertices. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/VertexTangents.h"

#include "osgRayTrace/base/Assert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

using Corner = std::array<float, 8>; ///< place, normal, coordinates

Corner cornerOf(const Mesh& mesh, const SharedArray<Vec2>& uvs, std::size_t vertex)
{
    const Vec3 p = mesh.positions[vertex], n = mesh.normals[vertex];
    const Vec2 uv = uvs[vertex];
    Corner corner{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
    for (float& value : corner)
        value += 0.0f; // -0 is 0
    return corner;
}

std::size_t hashOf(const Corner& corner)
{
    uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const float value : corner)
    {
        uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
        hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
}

/// Returns for each vertex the first one with the same place, normal and coordinates.
std::vector<uint32_t> firstAlike(const Mesh& mesh, const SharedArray<Vec2>& uvs)
{
    const std::size_t count = mesh.positions.size();
    std::size_t slots = 16;
    while (slots < 2 * count)
        slots *= 2;
    std::vector<uint32_t> table(slots, kInvalid), first(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        const Corner corner = cornerOf(mesh, uvs, i);
        std::size_t slot = hashOf(corner) & (slots - 1);
        while (table[slot] != kInvalid && cornerOf(mesh, uvs, table[slot]) != corner)
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == kInvalid) table[slot] = static_cast<uint32_t>(i);
        first[i] = table[slot];
    }
    return first;
}

/// Holds the direction in which s grows over a triangle [Lengyel01], and whether the coordinates
/// wind around the normals the other way; sign 0: it has no area in the texture.
struct TriangleTangent
{
    Vec3 alongS{0.0f};
    int sign = 0;
};

TriangleTangent tangentOf(const Mesh& mesh, const SharedArray<Vec2>& uvs, UVec3 t)
{
    const Vec3 b = mesh.positions[t.y] - mesh.positions[t.x];
    const Vec3 c = mesh.positions[t.z] - mesh.positions[t.x];
    const Vec2 p = uvs[t.y] - uvs[t.x], q = uvs[t.z] - uvs[t.x];
    const float area = p.x * q.y - p.y * q.x;
    if (!(std::fabs(area) > 0.0f)) return {};
    const float turn = area < 0.0f ? -1.0f : 1.0f;
    const Vec3 alongS = (b * q.y - c * p.y) * turn, alongT = (c * p.x - b * q.x) * turn;
    const float length = glm::length(alongS);
    if (!(length > 0.0f) || !(length < kInfinity)) return {};
    const Vec3 normal = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
    const bool mirrored = glm::dot(glm::cross(normal, alongS), alongT) < 0.0f;
    return {alongS / length, mirrored ? -1 : 1};
}

/// Returns a vector in the plane of a normal, of length 1 or 0.
Vec3 inPlane(Vec3 v, Vec3 normal)
{
    const Vec3 flat = v - normal * glm::dot(normal, v);
    const float length = glm::length(flat);
    return length > 0.0f && length < kInfinity ? flat / length : Vec3(0.0f);
}

/// Returns the angle of a triangle at a corner, seen along the normal.
float angleAt(Vec3 corner, Vec3 next, Vec3 last, Vec3 normal)
{
    const float cosine = glm::dot(inPlane(next - corner, normal), inPlane(last - corner, normal));
    return std::acos(glm::clamp(cosine, -1.0f, 1.0f));
}

/// Sums tangents by vertex and winding: group 2 v for the common one, 2 v + 1 for the other.
class TangentSums
{
public:
    TangentSums(const Mesh& mesh, const SharedArray<Vec2>& uvs)
        : _mesh(mesh), _first(firstAlike(mesh, uvs)), _sums(2 * mesh.positions.size(), Vec3(0.0f))
    {
        _signs.reserve(mesh.triangles.size());
        for (const UVec3& t : mesh.triangles)
        {
            const TriangleTangent tangent = tangentOf(mesh, uvs, t);
            _signs.push_back(static_cast<int8_t>(tangent.sign));
            if (tangent.sign != 0) add(t, tangent);
        }
    }

    VertexTangents result() const
    {
        VertexTangents made;
        std::vector<uint32_t> numbers(_sums.size(), kInvalid);
        for (std::size_t group = 0; group < _sums.size(); ++group)
        {
            const Vec3 sum = _sums[group];
            const float length = glm::length(sum);
            if (!(length > 1e-6f)) continue; // opposite directions leave none
            numbers[group] = static_cast<uint32_t>(made.tangents.size());
            made.tangents.emplace_back(sum / length, group % 2 == 0 ? 1.0f : -1.0f);
        }
        const auto numberOf = [&](std::size_t triangle, uint32_t vertex)
        {
            const std::size_t group = 2 * std::size_t(_first[vertex]);
            const std::size_t own = _signs[triangle] < 0 ? group + 1 : group;
            if (_signs[triangle] != 0 || numbers[own] != kInvalid) return numbers[own];
            return numbers[group + 1];
        };
        made.triangles.reserve(_mesh.triangles.size());
        for (std::size_t i = 0; i < _mesh.triangles.size(); ++i)
        {
            const UVec3 t = _mesh.triangles[i];
            made.triangles.emplace_back(numberOf(i, t.x), numberOf(i, t.y), numberOf(i, t.z));
        }
        return made;
    }

private:
    void add(UVec3 t, const TriangleTangent& tangent)
    {
        for (int k = 0; k < 3; ++k)
        {
            const uint32_t vertex = t[k], next = t[(k + 1) % 3], last = t[(k + 2) % 3];
            const auto& p = _mesh.positions;
            const Vec3 normal = _mesh.normals[vertex];
            const std::size_t group = 2 * std::size_t(_first[vertex]) + (tangent.sign < 0);
            _sums[group] +=
                inPlane(tangent.alongS, normal) * angleAt(p[vertex], p[next], p[last], normal);
        }
    }

    const Mesh& _mesh;
    std::vector<uint32_t> _first;
    std::vector<Vec3> _sums;
    std::vector<int8_t> _signs; ///< by triangle
};

} // namespace

VertexTangents vertexTangents(const Mesh& mesh, const SharedArray<Vec2>& uvs)
{
    OSGRAYTRACE_ASSERT(mesh.normals.size() == mesh.positions.size());
    OSGRAYTRACE_ASSERT(uvs.size() == mesh.positions.size());
    return TangentSums(mesh, uvs).result();
}

} // namespace osgRayTrace::engine
