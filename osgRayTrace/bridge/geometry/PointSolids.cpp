// PointSolids.cpp - tessellates spheres and capsules. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/PointSolids.h"

#include "osgRayTrace/bridge/common/ArrayReader.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/MatrixMaps.h"
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"
#include "osgRayTrace/bridge/geometry/PrimitiveModes.h"
#include "osgRayTrace/bridge/geometry/SolidShape.h"
#include "osgRayTrace/bridge/geometry/VertexArrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kLargestCoordinate = 1e18; ///< as for vertices of triangles

bool isUsable(const Vec3d& p)
{
    return std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
           std::fabs(p.z) <= kLargestCoordinate;
}

/// Returns the vertices in the geometry's own coordinates; NaN for vertices that cannot be read.
std::vector<Vec3d> localPositions(const osg::Geometry& geometry)
{
    const osg::Array* vertices = positionArray(geometry);
    std::vector<Vec3d> positions(vertices->getNumElements(),
                                 Vec3d(std::numeric_limits<double>::quiet_NaN()));
    forEachRow(*vertices, {positions.size()},
               [&positions](std::size_t i, const Vec4d& row)
               { positions[i] = Vec3d(row) / row.w; });
    return positions;
}

/// Returns the solids that can be traced, and counts the others.
std::vector<PointOrLine> soundSolids(const std::vector<PointOrLine>& solids,
                                     const std::vector<Vec3d>& positions, ConversionCounts& counts)
{
    std::vector<PointOrLine> sound;
    sound.reserve(solids.size());
    for (const PointOrLine& solid : solids)
    {
        const bool exists = solid.from < positions.size() && solid.to < positions.size();
        if (exists && isUsable(positions[solid.from]) && isUsable(positions[solid.to]))
            sound.push_back(solid);
        else
            ++counts["skipped.point-or-line"];
    }
    return sound;
}

/// Returns whether the solid has two ends. A line without a length is a sphere.
bool isCapsule(const PointOrLine& solid, const std::vector<Vec3d>& positions)
{
    return !solid.isPoint && positions[solid.from] != positions[solid.to];
}

/// Holds the axes of a solid; along goes from one end to the other.
struct Axes
{
    Vec3d across{1.0, 0.0, 0.0}, beside{0.0, 1.0, 0.0}, along{0.0, 0.0, 1.0};

    Vec3d operator()(const Vec3d& v) const { return across * v.x + beside * v.y + along * v.z; }
};

Axes axesOf(const Vec3d& from, const Vec3d& to)
{
    Axes axes;
    const Vec3d difference = to - from;
    const double largest =
        std::max({std::fabs(difference.x), std::fabs(difference.y), std::fabs(difference.z)});
    if (!(largest > 0.0)) return axes;
    axes.along = glm::normalize(difference / largest);
    const bool alongX = std::fabs(axes.along.x) > 0.7;
    axes.across = glm::normalize(
        glm::cross(axes.along, alongX ? Vec3d(0.0, 1.0, 0.0) : Vec3d(1.0, 0.0, 0.0)));
    axes.beside = glm::cross(axes.along, axes.across);
    return axes;
}

/// Collects the vertices and triangles of all solids of a mesh.
class SolidBuilder
{
public:
    SolidBuilder(const MeshRequest& request, std::size_t count, std::size_t firstVertex)
        : _shapes(solidShapes(count)),
          _point(request.transform),
          _normal(request.transform),
          _radius(double(request.pointRadius) * _shapes.outset),
          _mirrored(request.transform && isMirrored(*request.transform)),
          _firstVertex(firstVertex)
    {
    }

    void add(const PointOrLine& solid, const Vec3d& from, const Vec3d& to, bool capsule)
    {
        const SolidShape& shape = capsule ? _shapes.capsule : _shapes.sphere;
        const Axes axes = axesOf(from, to);
        const auto end = static_cast<uint32_t>(ends.rows.size());
        ends.rows.push_back(solid.from);
        ends.primitiveSets.push_back(solid.primitiveSet);
        if (capsule)
        {
            ends.rows.push_back(solid.to);
            ends.primitiveSets.push_back(solid.primitiveSet);
        }
        ends.vertexCount = ends.rows.size();
        const auto first = static_cast<uint32_t>(_firstVertex + positions.size());
        bool fits = true; // within what floats and Embree can hold, where the solid is placed
        for (const SolidVertex& vertex : shape.vertices)
        {
            const Vec3d direction = axes(vertex.direction);
            const Vec3d p = _point((vertex.atEnd ? to : from) + direction * _radius);
            fits = fits && isUsable(p);
            positions.push_back(fits ? Vec3(p) : Vec3(0.0f));
            normals.push_back(Vec3(glm::normalize(_normal(direction))));
            endOf.push_back(end + (vertex.atEnd ? 1 : 0));
        }
        if (fits)
            for (const UVec3& t : shape.triangles)
                triangles.push_back(UVec3(first) + (_mirrored ? UVec3(t.x, t.z, t.y) : t));
    }

    std::vector<Vec3> positions, normals;
    std::vector<uint32_t> endOf; ///< index into ends, for each position
    std::vector<UVec3> triangles;
    VertexMap ends; ///< the rows of both ends of each solid

private:
    const SolidShapes& _shapes;
    PointMap _point;
    NormalMap _normal;
    double _radius;
    bool _mirrored;
    std::size_t _firstVertex;
};

/// Gives each triangle of a mesh without normals vertices of its own, with the normals of facets.
void makeFlat(Mesh& mesh)
{
    const auto spread = [&mesh](auto& array)
    {
        if (array.empty()) return;
        std::vector<std::decay_t<decltype(array[0])>> values;
        values.reserve(3 * mesh.triangles.size() + 1);
        for (const UVec3& t : mesh.triangles)
            for (int corner = 0; corner < 3; ++corner)
                values.push_back(array[t[corner]]);
        array = std::move(values);
    };
    spread(mesh.uvs);
    spread(mesh.uvs1);
    for (SharedArray<Vec2>& uvs : mesh.moreUvs)
        spread(uvs);
    spread(mesh.rs);
    spread(mesh.rs1);
    spread(mesh.colors);
    spread(mesh.tangents);
    spread(mesh.positions);
    std::vector<UVec3> triangles;
    std::vector<Vec3> normals;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    {
        triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        const Vec3d a(mesh.positions[3 * i]), b(mesh.positions[3 * i + 1]),
            c(mesh.positions[3 * i + 2]);
        normals.insert(normals.end(), 3, Vec3(glm::normalize(glm::cross(b - a, c - a))));
    }
    mesh.triangles = std::move(triangles);
    mesh.normals = std::move(normals);
}

/// Returns values with those of more vertices behind them. An array that is missing beside another
/// one is filled; if both are missing, so is the result.
template <class T>
SharedArray<T> joined(const SharedArray<T>& values, std::size_t count, const SharedArray<T>& ofEnds,
                      const std::vector<uint32_t>& endOf, const T& filler)
{
    if (values.empty() && ofEnds.empty()) return {};
    std::vector<T> all;
    all.reserve(count + endOf.size() + 1); // Embree reads past the last position
    all.assign(values.begin(), values.end());
    all.resize(count, filler);
    for (const uint32_t end : endOf)
        all.push_back(ofEnds.empty() ? filler : ofEnds[end]);
    return all;
}

template <class T> SharedArray<T> joined(const SharedArray<T>& values, const std::vector<T>& more)
{
    std::vector<T> all;
    all.reserve(values.size() + more.size() + 1);
    all.assign(values.begin(), values.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

} // namespace

bool hasSolids(const osg::PrimitiveSet& set)
{
    return isPointOrLine(set.getMode()) && hasIndices(set);
}

std::size_t solidCount(const osg::Geometry& geometry)
{
    std::size_t count = 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        if (set && hasSolids(*set)) count += PrimitiveCounter(*set).count();
    return count;
}

float solidRadius(const osg::Geometry& geometry, float wanted)
{
    if (!(wanted > 0.0f)) return 0.0f;
    const std::size_t count = solidCount(geometry);
    return count > 0 && count <= kMostSolids ? wanted : 0.0f;
}

bool hasSolidsAlone(const osg::Geometry& geometry, float wanted)
{
    if (!(solidRadius(geometry, wanted) > 0.0f)) return false;
    const osg::Geometry::PrimitiveSetList& sets = geometry.getPrimitiveSetList();
    return std::none_of(sets.begin(), sets.end(),
                        [](const osg::ref_ptr<osg::PrimitiveSet>& set)
                        { return set && hasTriangles(*set); });
}

void appendSolids(const std::vector<PointOrLine>& solids, const osg::Geometry& geometry,
                  const MeshRequest& request, Mesh& mesh, ConversionCounts& counts)
{
    const std::vector<Vec3d> local = localPositions(geometry);
    const std::vector<PointOrLine> sound = soundSolids(solids, local, counts);
    if (sound.empty()) return;
    if (!mesh.triangles.empty() && mesh.normals.empty()) makeFlat(mesh);
    const std::size_t before = mesh.positions.size();
    SolidBuilder builder(request, sound.size(), before);
    for (const PointOrLine& solid : sound)
    {
        builder.add(solid, local[solid.from], local[solid.to], isCapsule(solid, local));
        ++counts[solid.isPoint ? "converted.point" : "converted.line"];
    }

    const VertexReader reader(geometry, request, builder.ends);
    const std::vector<uint32_t>& endOf = builder.endOf;
    mesh.uvs =
        joined(mesh.uvs, before, reader.textureCoordinates(geometry.getTexCoordArray(0), counts),
               endOf, Vec2(0.0f));
    mesh.uvs1 =
        joined(mesh.uvs1, before, reader.textureCoordinates(geometry.getTexCoordArray(1), counts),
               endOf, Vec2(0.0f));
    for (uint32_t set = kFirstMoreUvs; request.uvSets >> set != 0; ++set)
    {
        const std::size_t i = set - kFirstMoreUvs;
        if (i >= mesh.moreUvs.size()) mesh.moreUvs.emplace_back();
        if (!(request.uvSets >> set & 1u)) continue;
        mesh.moreUvs[i] = joined(mesh.moreUvs[i], before,
                                 reader.textureCoordinates(geometry.getTexCoordArray(set), counts),
                                 endOf, Vec2(0.0f));
    }
    mesh.rs =
        joined(mesh.rs, before, reader.thirdCoordinates(geometry.getTexCoordArray(0)), endOf, 0.0f);
    mesh.rs1 = joined(mesh.rs1, before, reader.thirdCoordinates(geometry.getTexCoordArray(1)),
                      endOf, 0.0f);
    mesh.colors = joined(mesh.colors, before, reader.colors(geometry.getColorArray(), counts),
                         endOf, Vec4(1.0f));
    mesh.tangents =
        joined(mesh.tangents, before, reader.tangents(tangentArray(geometry)), endOf, Vec4(0.0f));
    mesh.positions = joined(mesh.positions, builder.positions);
    mesh.normals = joined(mesh.normals, builder.normals);
    mesh.triangles = joined(mesh.triangles, builder.triangles);
}

SolidNumbers::SolidNumbers(const std::vector<PointOrLine>& solids, const osg::Geometry& geometry)
{
    const std::vector<Vec3d> local = localPositions(geometry);
    ConversionCounts counts;
    const std::vector<PointOrLine> sound = soundSolids(solids, local, counts);
    const SolidShapes& shapes = solidShapes(sound.size());
    std::size_t first = 0;
    for (const PointOrLine& solid : sound)
    {
        _firstVertices.push_back(first);
        _primitives.push_back(solid.primitive);
        first += (isCapsule(solid, local) ? shapes.capsule : shapes.sphere).vertices.size();
    }
    _firstVertices.push_back(first);
}

uint32_t SolidNumbers::primitiveOf(std::size_t vertex) const
{
    const auto next = std::upper_bound(_firstVertices.begin(), _firstVertices.end(), vertex);
    if (next == _firstVertices.begin() || next == _firstVertices.end()) return kInvalid;
    return _primitives[static_cast<std::size_t>(next - _firstVertices.begin()) - 1];
}

} // namespace osgRayTrace::engine
