// PrimitiveNumbers.cpp - finds the triangles of a mesh among those of its geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/pick/PrimitiveNumbers.h"

#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/GeometryConverter.h"
#include "osgRayTrace/bridge/geometry/PointSolids.h"
#include "osgRayTrace/bridge/geometry/TriangleCollector.h"

#include <map>
#include <tuple>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether every triangle is a primitive, and none was dropped.
bool isPlainList(const osg::Geometry& geometry, const PrimitiveRestart& restart, const Mesh& mesh)
{
    if (restart.on || hasValuesBySet(geometry)) return false;
    std::size_t triangles = 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
    {
        const bool plain = set && set->getMode() == GL_TRIANGLES && hasTriangles(*set) &&
                           set->getNumIndices() % 3 == 0 &&
                           set->getType() != osg::PrimitiveSet::DrawArrayLengthsPrimitiveType &&
                           set->getType() != osg::PrimitiveSet::MultiDrawArraysPrimitiveType;
        if (!plain) return false;
        triangles += set->getNumIndices() / 3;
    }
    return triangles == mesh.triangles.size();
}

/// Returns whether two triangles are equal; those of mirrored meshes are turned.
bool isSame(const UVec3& mesh, const UVec3& geometry)
{
    return mesh == geometry ||
           (mesh.x == geometry.x && mesh.y == geometry.z && mesh.z == geometry.y);
}

/// Finds the place of each triangle of a mesh among its geometry's. The triangles of a mesh are
/// those of its geometry in their order, without those that were dropped; some may have been cut.
class Finder
{
public:
    explicit Finder(const std::vector<UVec3>& triangles) : _triangles(triangles) {}

    uint32_t find(const UVec3& t)
    {
        if (!_inOrder) return search(t);
        for (std::size_t i = _next; i < _triangles.size(); ++i)
        {
            if (!isSame(t, _triangles[i])) continue;
            _next = i + 1;
            return static_cast<uint32_t>(i);
        }
        // Absent, or not in order: there is no second walk through all triangles.
        _inOrder = false;
        return search(t);
    }

private:
    using Key = std::tuple<uint32_t, uint32_t, uint32_t>;
    static Key keyOf(const UVec3& t) { return {t.x, t.y, t.z}; }

    uint32_t search(const UVec3& t)
    {
        if (_places.empty())
            for (uint32_t i = 0; i < _triangles.size(); ++i)
                _places.try_emplace(keyOf(_triangles[i]), i);
        auto found = _places.find(keyOf(t));
        if (found == _places.end()) found = _places.find(keyOf(UVec3(t.x, t.z, t.y)));
        return found == _places.end() ? kInvalid : found->second;
    }

    const std::vector<UVec3>& _triangles;
    std::size_t _next = 0;
    bool _inOrder = true;
    std::map<Key, uint32_t> _places; // filled if triangles are not in order
};

} // namespace

PrimitiveNumbers::PrimitiveNumbers(const osg::Geometry& geometry, const PrimitiveRestart& restart,
                                   bool solids, const Mesh& mesh)
    : _triangles(mesh.triangles)
{
    const osg::Array* vertices = positionArray(geometry);
    _vertexCount = vertices ? vertices->getNumElements() : 0;
    // A cut mesh may have gained as many triangles as it lost.
    const bool cut = mesh.positions.size() != _vertexCount;
    if (!cut && isPlainList(geometry, restart, mesh)) return;

    TriangleList list = trianglesOf(geometry, _vertexCount, restart, {true, solids});
    if (hasValuesBySet(geometry))
    {
        VertexMap map = splitByPrimitiveSet(list, _vertexCount);
        _vertexCount = static_cast<uint32_t>(map.vertexCount);
        _rows = std::move(map.rows);
    }
    Finder finder(list.triangles);
    _primitives.reserve(mesh.triangles.size());
    for (const UVec3& t : mesh.triangles)
    {
        const bool own = t.x < _vertexCount && t.y < _vertexCount && t.z < _vertexCount;
        const uint32_t place = own ? finder.find(t) : kInvalid;
        _primitives.push_back(place == kInvalid ? kInvalid : list.primitives[place]);
    }
    if (!list.solids.empty()) numberSolids(list, geometry, mesh);
}

/// Numbers the triangles of points and lines. Their vertices are the last ones of the mesh, unless
/// it was cut: triangles of solids then have no number.
void PrimitiveNumbers::numberSolids(const TriangleList& list, const osg::Geometry& geometry,
                                    const Mesh& mesh)
{
    const SolidNumbers numbers(list.solids, geometry);
    if (mesh.positions.size() < numbers.vertexCount()) return;
    const std::size_t first = mesh.positions.size() - numbers.vertexCount();
    if (first != 0 && first != _vertexCount) return;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.triangles[i].x >= first)
            _primitives[i] = numbers.primitiveOf(mesh.triangles[i].x - first);
    _vertexCount = static_cast<uint32_t>(first);
}

GeometryTriangle PrimitiveNumbers::at(uint32_t triangle) const
{
    GeometryTriangle result;
    if (triangle >= _triangles.size()) return result;
    const UVec3& t = _triangles[triangle];
    result.primitive = _primitives.empty() ? triangle : _primitives[triangle];
    if (t.x >= _vertexCount || t.y >= _vertexCount || t.z >= _vertexCount) return result;
    result.rows = _rows.empty() ? t : UVec3(_rows[t.x], _rows[t.y], _rows[t.z]);
    return result;
}

} // namespace osgRayTrace::engine
