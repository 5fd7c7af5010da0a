// GeometryConverter.cpp - checks triangles and vertices and makes a mesh of them. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/GeometryConverter.h"
#include "osgRayTrace/bridge/geometry/TriangleCollector.h"

#include "osgRayTrace/bridge/geometry/HostArrays.h"
#include "osgRayTrace/bridge/geometry/MeshClipper.h"
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"
#include "osgRayTrace/bridge/geometry/MovedTangents.h"
#include "osgRayTrace/bridge/geometry/PointSolids.h"
#include "osgRayTrace/bridge/geometry/VertexArrays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether the triangle's area is exactly zero. Differences of floats and their products
/// are exact in double for all but extreme exponents, so this finds collinear corners and nothing
/// else.
bool hasNoArea(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3d u = Vec3d(b) - Vec3d(a);
    const Vec3d v = Vec3d(c) - Vec3d(a);
    return (u.y * v.z == u.z * v.y) & (u.z * v.x == u.x * v.z) & (u.x * v.y == u.y * v.x);
}

/// Names the results of a triangle's tests, in their order.
enum class Verdict
{
    Sound,
    OutOfRange,
    NotFinite,
    Degenerate,
};

class TriangleJudge
{
public:
    explicit TriangleJudge(const Positions& positions)
        : _positions(positions.values.data()),
          _unsound(positions.unsound.empty() ? nullptr : positions.unsound.data()),
          _count(positions.values.size())
    {
    }

    Verdict operator()(const UVec3& t) const
    {
        if (t.x >= _count || t.y >= _count || t.z >= _count) return Verdict::OutOfRange;
        if (_unsound && (_unsound[t.x] | _unsound[t.y] | _unsound[t.z])) return Verdict::NotFinite;
        if (hasNoArea(_positions[t.x], _positions[t.y], _positions[t.z]))
            return Verdict::Degenerate;
        return Verdict::Sound;
    }

    /// Returns whether all triangles are sound: the common case, without a branch for each
    /// triangle.
    bool allSound(const UVec3* triangles, std::size_t count) const
    {
        if (_unsound) return false;
        uint32_t largest = 0;
        const uint32_t* indices = &triangles->x;
        for (std::size_t i = 0; i < 3 * count; ++i)
            largest = std::max(largest, indices[i]);
        if (largest >= _count) return false;
        unsigned int degenerate = 0;
        for (std::size_t i = 0; i < count; ++i)
        {
            const UVec3& t = triangles[i];
            degenerate |= hasNoArea(_positions[t.x], _positions[t.y], _positions[t.z]);
        }
        return degenerate == 0;
    }

private:
    const Vec3* _positions;
    const uint8_t* _unsound;
    std::size_t _count;
};

void countVerdict(Verdict verdict, ConversionCounts& counts)
{
    switch (verdict)
    {
    case Verdict::OutOfRange:
        ++counts["skipped.index-out-of-range"];
        break;
    case Verdict::NotFinite:
        ++counts["skipped.not-finite"];
        break;
    case Verdict::Degenerate:
        ++counts["skipped.degenerate"];
        break;
    case Verdict::Sound:
        break;
    }
}

std::vector<UVec3> soundTriangles(const UVec3* triangles, std::size_t count,
                                  const TriangleJudge& judge, ConversionCounts& counts)
{
    std::vector<UVec3> kept;
    kept.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        const Verdict verdict = judge(triangles[i]);
        if (verdict == Verdict::Sound) kept.push_back(triangles[i]);
        countVerdict(verdict, counts);
    }
    return kept;
}

SharedArray<UVec3> shareIndices(const osg::DrawElementsUInt& elements)
{
    return {reinterpret_cast<const UVec3*>(&elements.front()), elements.size() / 3,
            keepHostArray(elements)};
}

SharedArray<UVec3> checkedTriangles(TriangleList& list, const osg::Geometry& geometry,
                                    const Positions& positions, const MeshRequest& request,
                                    ConversionCounts& counts)
{
    if (list.size() == 0) return {};
    const TriangleJudge judge(positions);
    const bool sound = judge.allSound(list.data(), list.size());
    // A mirrored triangle has to be turned back, so that its front stays its front.
    const bool mirrored = request.transform && isMirrored(*request.transform);
    if (sound && list.source && !mirrored && !request.copies &&
        geometry.getDataVariance() != osg::Object::DYNAMIC &&
        list.source->getDataVariance() != osg::Object::DYNAMIC)
        return shareIndices(*list.source);

    std::vector<UVec3> triangles;
    if (!sound)
        triangles = soundTriangles(list.data(), list.size(), judge, counts);
    else if (list.source)
        triangles.assign(list.data(), list.data() + list.size());
    else
        triangles = std::move(list.triangles);
    if (mirrored)
        for (UVec3& t : triangles)
            std::swap(t.y, t.z);
    return triangles;
}

Vec3 faceNormal(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return Vec3(glm::normalize(glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
}

/// Returns the normals with each missing one replaced by that of a triangle that uses it, and
/// counts them.
SharedArray<Vec3> completed(Normals& normals, const Mesh& mesh, ConversionCounts& counts)
{
    if (normals.missing.empty()) return std::move(normals.values);
    std::vector<Vec3> values(normals.values.begin(), normals.values.end());
    uint64_t repaired = 0;
    for (const UVec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
        {
            uint8_t& missing = normals.missing[t[corner]];
            if (!missing) continue;
            values[t[corner]] =
                faceNormal(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
            missing = 0;
            ++repaired;
        }
    for (std::size_t i = 0; i < values.size(); ++i)
        if (normals.missing[i]) values[i] = Vec3(0.0f, 0.0f, 1.0f); // no triangle uses it
    if (repaired > 0) counts["repaired.normal"] += repaired;
    return values;
}

/// Returns whether the corners are so nearly in one line that rounding decides on which side the
/// face's front is, as at the poles of OSG's own spheres. face is the cross product of two edges
/// from a.
bool hasNoSide(Vec3d face, Vec3d a, Vec3d b, Vec3d c)
{
    const double edge = std::max(glm::length(b - a), glm::length(c - a));
    const double coordinate = std::max({glm::length(a), glm::length(b), glm::length(c)});
    return glm::length(face) <= 8.0 * 0x1p-24 * coordinate * edge;
}

/// Counts the triangles whose normals all look to the triangle's back: they are shaded on the side
/// that is seen.
uint64_t oppositeNormals(const Mesh& mesh)
{
    if (mesh.normals.empty()) return 0;
    const Vec3* positions = mesh.positions.data();
    const Vec3* normals = mesh.normals.data();
    uint64_t count = 0;
    for (const UVec3& t : mesh.triangles)
    {
        const Vec3d a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
        const Vec3d face = glm::cross(b - a, c - a);
        const bool opposite = (glm::dot(face, Vec3d(normals[t.x])) < 0.0) &
                              (glm::dot(face, Vec3d(normals[t.y])) < 0.0) &
                              (glm::dot(face, Vec3d(normals[t.z])) < 0.0);
        if (opposite && !hasNoSide(face, a, b, c)) ++count;
    }
    return count;
}

/// Thickness of a layer, as a share of the largest coordinate: some hundred times the rounding of
/// hit points, and a hundredth of a pixel if the whole mesh is in view.
constexpr float kLayer = 0x1p-16f;

/// Returns the positions with all faces raised on their front side, so that a ray hits a decal
/// before the surface under it. OpenGL instead moves the depth towards the viewer, on either side;
/// seen from behind, the order here is therefore reversed.
SharedArray<Vec3> biased(const Mesh& mesh, float layers)
{
    std::vector<Vec3d> directions(mesh.positions.size(), Vec3d(0.0));
    for (const UVec3& t : mesh.triangles)
    {
        const Vec3d face =
            faceNormal(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
        for (int corner = 0; corner < 3; ++corner)
            directions[t[corner]] += face;
    }
    float largest = 0.0f;
    for (const Vec3& p : mesh.positions)
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    const double height = double(layers) * kLayer * largest;
    std::vector<Vec3> positions;
    positions.reserve(mesh.positions.size() + 1); // Embree reads past the last one
    for (std::size_t i = 0; i < directions.size(); ++i)
    {
        const double length = glm::length(directions[i]);
        const Vec3d up = length > 0.0 ? directions[i] * (height / length) : Vec3d(0.0);
        positions.push_back(Vec3(Vec3d(mesh.positions[i]) + up));
    }
    return positions;
}

} // namespace

bool hasValuesBySet(const osg::Geometry& geometry)
{
    const auto perSet = osg::Array::BIND_PER_PRIMITIVE_SET;
    return bindingOf(geometry.getNormalArray()) == perSet ||
           bindingOf(geometry.getColorArray()) == perSet;
}

VertexMap splitByPrimitiveSet(TriangleList& list, std::size_t vertexCount)
{
    if (list.source)
    {
        list.triangles.assign(list.data(), list.data() + list.size());
        list.source = nullptr;
    }
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> newIndex(vertexCount, kNone);
    std::vector<uint32_t> lastSet(vertexCount, kNone);
    VertexMap map;
    std::size_t begin = 0;
    for (uint32_t set = 0; set < list.setEnds.size(); ++set)
    {
        for (std::size_t i = begin; i < list.setEnds[set]; ++i)
            for (int corner = 0; corner < 3; ++corner)
            {
                uint32_t& index = list.triangles[i][corner];
                if (index >= vertexCount)
                {
                    index = kNone;
                    continue;
                }
                if (lastSet[index] != set)
                {
                    lastSet[index] = set;
                    newIndex[index] = static_cast<uint32_t>(map.rows.size());
                    map.rows.push_back(index);
                    map.primitiveSets.push_back(set);
                }
                index = newIndex[index];
            }
        begin = list.setEnds[set];
    }
    map.vertexCount = map.rows.size();
    return map;
}

namespace
{

/// Drops the triangles of solids that are so small beside their coordinates that floats leave them
/// no area.
void keepAreas(Mesh& mesh, ConversionCounts& counts)
{
    const Positions positions{mesh.positions, {}};
    const TriangleJudge judge(positions);
    if (mesh.triangles.empty() || judge.allSound(mesh.triangles.data(), mesh.triangles.size()))
        return;
    mesh.triangles = soundTriangles(mesh.triangles.data(), mesh.triangles.size(), judge, counts);
}

/// Reads the triangles of a list, and the arrays at their vertices; the mesh stays empty if no
/// triangle is sound.
void readTriangles(TriangleList& list, const osg::Geometry& geometry, const osg::Array& vertices,
                   const MeshRequest& request, const KeptArrays& kept, Mesh& mesh,
                   ConversionCounts& counts)
{
    VertexMap map;
    map.vertexCount = vertices.getNumElements();
    if (hasValuesBySet(geometry)) map = splitByPrimitiveSet(list, map.vertexCount);
    const VertexReader reader(geometry, request, map);
    Positions positions = reader.positions(vertices);
    mesh.triangles = checkedTriangles(list, geometry, positions, request, counts);
    if (mesh.triangles.empty()) return;

    mesh.positions = std::move(positions.values);
    const auto fits = [&mesh](const auto& array) { return array.size() == mesh.positions.size(); };
    if (fits(kept.normals))
        mesh.normals = kept.normals;
    else
    {
        Normals normals = reader.normals(geometry.getNormalArray());
        mesh.normals = completed(normals, mesh, counts);
    }
    if (const uint64_t opposite = oppositeNormals(mesh))
        counts["warned.opposite-normals"] += opposite;
    mesh.uvs =
        fits(kept.uvs) ? kept.uvs : reader.textureCoordinates(geometry.getTexCoordArray(0), counts);
    if (geometry.getNumTexCoordArrays() > 1)
        mesh.uvs1 = fits(kept.uvs1)
                        ? kept.uvs1
                        : reader.textureCoordinates(geometry.getTexCoordArray(1), counts);
    mesh.rs = fits(kept.rs) ? kept.rs : reader.thirdCoordinates(geometry.getTexCoordArray(0));
    mesh.rs1 = fits(kept.rs1) ? kept.rs1 : reader.thirdCoordinates(geometry.getTexCoordArray(1));
    for (uint32_t set = kFirstMoreUvs; request.uvSets >> set != 0; ++set)
    {
        SharedArray<Vec2>& uvs = mesh.moreUvs.emplace_back();
        if (!(request.uvSets >> set & 1u)) continue;
        const std::size_t i = set - kFirstMoreUvs;
        uvs = i < kept.moreUvs.size() && fits(kept.moreUvs[i])
                  ? kept.moreUvs[i]
                  : reader.textureCoordinates(geometry.getTexCoordArray(set), counts);
    }
    mesh.colors = fits(kept.colors) ? kept.colors : reader.colors(geometry.getColorArray(), counts);
    mesh.tangents = reader.tangents(tangentsNow(geometry, request.copies).get());
}

} // namespace

ConvertedMesh convertGeometry(const osg::Geometry& geometry, const MeshRequest& request,
                              const KeptArrays& kept)
{
    ConvertedMesh result;
    const auto skip = [&result](const char* reason)
    {
        ++result.counts[reason];
        return std::move(result);
    };
    if (geometry.containsDeprecatedData()) return skip("skipped.deprecated-data");
    const osg::Array* vertices = positionArray(geometry);
    if (!vertices || vertices->getNumElements() == 0) return skip("not-traced.no-vertices");
    if (!isReadable(vertices) || vertices->getDataSize() < 2) return skip("skipped.vertex-type");

    const bool solids = request.pointRadius > 0.0f;
    TriangleList list =
        trianglesOf(geometry, vertices->getNumElements(), request.restart, {false, solids});
    addCounts(result.counts, list.counts);
    auto mesh = std::make_shared<Mesh>();
    readTriangles(list, geometry, *vertices, request, kept, *mesh, result.counts);
    if (!list.solids.empty())
    {
        appendSolids(list.solids, geometry, request, *mesh, result.counts);
        keepAreas(*mesh, result.counts);
    }
    if (mesh->triangles.empty()) return result;
    if (request.depthBias != 0.0f) mesh->positions = biased(*mesh, request.depthBias);
    if (!request.clipPlanes.empty()) clip(*mesh, request.clipPlanes);
    if (mesh->triangles.empty()) return skip("not-traced.clipped-away");
    result.mesh = std::move(mesh);
    return result;
}

} // namespace osgRayTrace::engine
