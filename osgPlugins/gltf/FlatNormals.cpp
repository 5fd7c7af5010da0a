// FlatNormals.cpp - gives each triangle vertices of its own. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/FlatNormals.h"

#include <osg/TriangleIndexFunctor>

namespace osgRayTrace::gltf
{

namespace
{

using Corners = std::vector<unsigned int>;

/// Collects the corners of triangles, those without an area as well: the numbers of triangles stay
/// those of the file.
struct CollectCorners
{
    Corners corners;

    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        corners.insert(corners.end(), {a, b, c});
    }
};

template <typename ArrayType>
osg::ref_ptr<ArrayType> gathered(const osg::ref_ptr<ArrayType>& from, const Corners& corners)
{
    if (!from) return nullptr;
    const osg::ref_ptr<ArrayType> result = new ArrayType(osg::Array::BIND_PER_VERTEX);
    result->setNormalize(from->getNormalize());
    result->reserve(corners.size());
    for (const unsigned int corner : corners)
        result->push_back((*from)[corner]);
    return result;
}

osg::ref_ptr<osg::Array> gatheredColors(const osg::ref_ptr<osg::Array>& from,
                                        const Corners& corners)
{
    if (const osg::ref_ptr<osg::Vec4ubArray> bytes = dynamic_cast<osg::Vec4ubArray*>(from.get()))
        return gathered(bytes, corners);
    return gathered(osg::ref_ptr<osg::Vec4Array>(static_cast<osg::Vec4Array*>(from.get())),
                    corners);
}

osg::ref_ptr<osg::Vec3Array> facetNormals(const osg::Vec3Array& positions)
{
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
    normals->reserve(positions.size());
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    {
        const osg::Vec3d a = positions[i], b = positions[i + 1], c = positions[i + 2];
        osg::Vec3d normal = (b - a) ^ (c - a);
        if (!(normal.normalize() > 0.0)) normal.set(0.0, 0.0, 1.0);
        normals->insert(normals->end(), 3, osg::Vec3(normal));
    }
    return normals;
}

/// Returns a target whose normals take the flat ones of the mesh to those of the moved mesh.
MorphTarget flatTarget(const Vertices& flat, const osg::ref_ptr<osg::Vec3Array>& moves,
                       const Corners& corners)
{
    MorphTarget target;
    target.positions = gathered(moves, corners);
    if (!target.positions) return target;
    const osg::ref_ptr<osg::Vec3Array> moved =
        new osg::Vec3Array(flat.positions->begin(), flat.positions->end());
    for (std::size_t i = 0; i < moved->size(); ++i)
        (*moved)[i] += (*target.positions)[i];
    target.normals = facetNormals(*moved);
    for (std::size_t i = 0; i < target.normals->size(); ++i)
        (*target.normals)[i] -= (*flat.normals)[i];
    return target;
}

/// Returns the number of corners of triangles.
std::uint64_t cornersOf(const osg::PrimitiveSet& primitives)
{
    const std::uint64_t indices = primitives.getNumIndices();
    if (primitives.getMode() == GL_TRIANGLES) return indices / 3 * 3;
    return indices > 2 ? 3 * (indices - 2) : 0; // strips and fans
}

/// Returns the bytes of a corner, a position, a normal and the other arrays among them.
std::uint64_t bytesOfCorner(const Vertices& vertices)
{
    return sizeof(unsigned int) + 2 * sizeof(osg::Vec3f) +
           vertices.texcoords.size() * sizeof(osg::Vec2f) +
           (vertices.colors ? sizeof(osg::Vec4f) : 0) +
           vertices.jointSets.size() * (sizeof(osg::Vec4f) + 4 * sizeof(std::uint16_t));
}

} // namespace

bool isOfTriangles(const osg::PrimitiveSet& primitives)
{
    return primitives.getMode() >= GL_TRIANGLES;
}

Vertices withFlatNormals(const Vertices& vertices, Document& document, const JsonPlace& place)
{
    document.take(cornersOf(*vertices.primitives) * bytesOfCorner(vertices), place);
    osg::TriangleIndexFunctor<CollectCorners> collect;
    vertices.primitives->accept(collect);
    const Corners& corners = collect.corners;
    document.take(std::uint64_t(corners.size()) * 24 * vertices.targets.size(), place);

    Vertices flat;
    flat.positions = gathered(vertices.positions, corners);
    flat.normals = facetNormals(*flat.positions);
    for (const auto& texcoord : vertices.texcoords)
        flat.texcoords.push_back(gathered(texcoord, corners));
    flat.colors = gatheredColors(vertices.colors, corners);
    for (const JointSet& set : vertices.jointSets)
    {
        JointSet own;
        own.weights = gathered(set.weights, corners);
        for (const unsigned int corner : corners)
            own.joints.push_back(set.joints[corner]);
        flat.jointSets.push_back(std::move(own));
    }
    for (const MorphTarget& target : vertices.targets)
        flat.targets.push_back(flatTarget(flat, target.positions, corners));
    flat.primitives = new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size()));
    return flat;
}

} // namespace osgRayTrace::gltf
