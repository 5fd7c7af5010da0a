// ClosedMesh.cpp - welds vertices and pairs edges. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/ClosedMesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kWeldShare = 1e-6; ///< of the mesh's size

/// Finds vertices by their place. A vertex is entered in the cell of a grid that it lies in, and
/// looked for in all cells that its surroundings touch.
class Welder
{
public:
    Welder(const Mesh& mesh, double distance) : _mesh(mesh), _distance(distance)
    {
        _next.reserve(mesh.positions.size());
        _first.reserve(mesh.positions.size());
    }

    /// Returns the first vertex at the place of this one. Vertices are to be asked for in turn.
    uint32_t weld(uint32_t vertex)
    {
        const Vec3d place(_mesh.positions[vertex]);
        for (int corner = 0; corner < 8; ++corner)
        {
            const Vec3d offset(corner & 1 ? _distance : -_distance,
                               corner & 2 ? _distance : -_distance,
                               corner & 4 ? _distance : -_distance);
            const auto found = _first.find(cellOf(place + offset));
            if (found == _first.end()) continue;
            for (uint32_t other = found->second; other != kInvalid; other = _next[other])
                if (isNear(place, Vec3d(_mesh.positions[other])))
                {
                    _next.push_back(kInvalid);
                    return other;
                }
        }
        const auto [entry, added] = _first.emplace(cellOf(place), kInvalid);
        _next.push_back(entry->second);
        entry->second = vertex;
        return vertex;
    }

private:
    uint64_t cellOf(const Vec3d& place) const
    {
        uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double cell = std::floor(place[axis] / (4.0 * _distance));
            hash = (hash ^ static_cast<uint64_t>(static_cast<int64_t>(cell))) *
                   uint64_t(0x9e3779b97f4a7c15);
        }
        return hash;
    }

    bool isNear(const Vec3d& a, const Vec3d& b) const
    {
        return glm::all(glm::lessThanEqual(glm::abs(a - b), Vec3d(_distance)));
    }

    const Mesh& _mesh;
    const double _distance;
    std::unordered_map<uint64_t, uint32_t> _first; ///< a vertex by its cell
    std::vector<uint32_t> _next;                   ///< another vertex of the same cell, by vertex
};

std::vector<uint32_t> weldedVertices(const Mesh& mesh)
{
    Vec3d low(0.0), high(0.0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    {
        const Vec3d place(mesh.positions[i]);
        low = i == 0 ? place : glm::min(low, place);
        high = i == 0 ? place : glm::max(high, place);
    }
    const double size = glm::length(high - low);
    Welder welder(mesh, size > 0.0 ? kWeldShare * size : 1.0);
    std::vector<uint32_t> welded;
    welded.reserve(mesh.positions.size());
    for (uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
        welded.push_back(welder.weld(vertex));
    return welded;
}

/// An edge, from its lower vertex to its upper one, and whether its triangle has it so.
struct Edge
{
    uint64_t vertices;
    int direction;
};

} // namespace

bool isClosed(const Mesh& mesh)
{
    const std::vector<uint32_t> welded = weldedVertices(mesh);
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const UVec3& triangle : mesh.triangles)
        for (int side = 0; side < 3; ++side)
        {
            const uint64_t a = welded[triangle[side]], b = welded[triangle[(side + 1) % 3]];
            if (a < b) edges.push_back({a << 32 | b, 1});
            if (b < a) edges.push_back({b << 32 | a, -1});
        }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.vertices < b.vertices; });
    int balance = 0;
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        balance += edges[i].direction;
        const bool last = i + 1 == edges.size() || edges[i + 1].vertices != edges[i].vertices;
        if (last && balance != 0) return false;
    }
    return true;
}

bool ClosedMeshes::isClosed(const Mesh& mesh)
{
    const auto [entry, added] = _known.try_emplace(mesh.triangles.data());
    if (added) entry->second = {mesh.triangles, engine::isClosed(mesh), true};
    entry->second.used = true;
    return entry->second.closed;
}

void ClosedMeshes::begin()
{
    for (auto& [triangles, entry] : _known)
        entry.used = false;
}

void ClosedMeshes::end()
{
    for (auto it = _known.begin(); it != _known.end();)
        it = it->second.used ? std::next(it) : _known.erase(it);
}

} // namespace osgRayTrace::engine
