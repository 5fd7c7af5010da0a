// VertexReader.h - the vertices of a primitive as arrays of OSG. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Accessor.h"
#include "osgPlugins/gltf/DracoPrimitive.h"

#include <osg/Array>
#include <osg/PrimitiveSet>

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace osgRayTrace::gltf
{

/// What a vertex is moved by while its target has the weight 1. Null: not at all.
struct MorphTarget
{
    osg::ref_ptr<osg::Vec3Array> positions;
    osg::ref_ptr<osg::Vec3Array> normals;
    osg::ref_ptr<osg::Vec3Array> tangents; ///< null unless readTargetTangents was called
};

/// Joints, by their numbers in the skin, and weights: four of a vertex.
struct JointSet
{
    std::vector<std::array<std::uint16_t, 4>> joints;
    osg::ref_ptr<osg::Vec4Array> weights;
};

/// The vertices of a primitive. Arrays are null if the file has none, else all of one length.
struct Vertices
{
    osg::ref_ptr<osg::Vec3Array> positions;
    osg::ref_ptr<osg::Vec3Array> normals;
    osg::ref_ptr<osg::Vec4Array> tangents; ///< w: the bitangent is w * cross(normal, tangent)
    std::vector<osg::ref_ptr<osg::Vec2Array>> texcoords; ///< v goes up, as in OSG
    osg::ref_ptr<osg::Array> colors; ///< Vec4ubArray or Vec4Array, display-referred
    std::vector<JointSet> jointSets;
    std::vector<MorphTarget> targets;
    osg::ref_ptr<osg::PrimitiveSet> primitives; ///< null: there is nothing to draw

    std::size_t count() const { return positions->size(); }
};

class VertexReader
{
public:
    explicit VertexReader(Document& document) : _accessors(document), _draco(_accessors) {}

    VertexReader(const VertexReader&) = delete;
    VertexReader& operator=(const VertexReader&) = delete;

    /// Reads a primitive. Accessors that several primitives use give one array. Throws GltfError.
    Vertices read(const JsonPlace& primitive);

    /// Reads what targets move tangents by, for a surface that uses them; a line says so if they
    /// cannot be moved, because the primitive has none. Throws GltfError.
    void readTargetTangents(const JsonPlace& primitive, Vertices& vertices);

    AccessorReader& accessors() { return _accessors; }

private:
    enum class Role
    {
        Plain,
        Texcoord,
        Color
    };

    template <typename ArrayType>
    osg::ref_ptr<ArrayType> floats(const JsonPlace& index, Role role = Role::Plain);
    osg::ref_ptr<osg::Array> colors(const JsonPlace& index);
    JointSet jointSet(const JsonPlace& attributes, std::size_t set);
    std::vector<MorphTarget> targets(const JsonPlace& primitive);
    osg::ref_ptr<osg::PrimitiveSet> primitives(const JsonPlace& primitive, std::size_t vertices);
    void checkCounts(const Vertices& vertices, const JsonPlace& primitive) const;

    AccessorReader _accessors;
    DracoPrimitive _draco;
    std::map<std::pair<std::size_t, Role>, osg::ref_ptr<osg::Array>> _arrays;
    std::map<std::tuple<std::size_t, GLenum, std::size_t>, osg::ref_ptr<osg::PrimitiveSet>>
        _primitives; ///< by accessor, mode and number of vertices
};

} // namespace osgRayTrace::gltf
