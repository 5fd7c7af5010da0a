// DrawableTriangles.cpp - reads drawables by osg::PrimitiveFunctor, and copies what they choose.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/DrawableTriangles.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/common/Unshared.h"
#include "osgRayTrace/bridge/geometry/BufferHashes.h"
#include "osgRayTrace/bridge/geometry/PrimitiveModes.h"
#include "osgRayTrace/scene/Mesh.h"

#include <typeinfo>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// Records vertices of any type, and the triangles of all primitives that have any.
class Reader : public osg::PrimitiveFunctor
{
public:
    void setVertexArray(unsigned int count, const osg::Vec2* v) override { setVertices(count, v); }
    void setVertexArray(unsigned int count, const osg::Vec3* v) override { setVertices(count, v); }
    void setVertexArray(unsigned int count, const osg::Vec4* v) override { setVertices(count, v); }
    void setVertexArray(unsigned int count, const osg::Vec2d* v) override { setVertices(count, v); }
    void setVertexArray(unsigned int count, const osg::Vec3d* v) override { setVertices(count, v); }
    void setVertexArray(unsigned int count, const osg::Vec4d* v) override { setVertices(count, v); }

    void drawArrays(GLenum mode, GLint first, GLsizei count) override
    {
        add(mode, count, [first](std::size_t i) { return std::size_t(first) + i; });
    }
    void drawElements(GLenum mode, GLsizei count, const GLubyte* indices) override
    {
        add(mode, count, [indices](std::size_t i) { return std::size_t(indices[i]); });
    }
    void drawElements(GLenum mode, GLsizei count, const GLushort* indices) override
    {
        add(mode, count, [indices](std::size_t i) { return std::size_t(indices[i]); });
    }
    void drawElements(GLenum mode, GLsizei count, const GLuint* indices) override
    {
        add(mode, count, [indices](std::size_t i) { return std::size_t(indices[i]); });
    }

    uint64_t hash() const
    {
        return fold(memoryHash(_vertices.data(), _vertices.size() * sizeof(osg::Vec3)),
                    memoryHash(_triangles.data(), _triangles.size() * sizeof(UVec3)));
    }

    bool empty() const { return _triangles.empty(); }

    void moveTo(osg::Geometry& geometry)
    {
        geometry.setVertexArray(new osg::Vec3Array(_vertices.begin(), _vertices.end()));
        const osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
        for (const UVec3& t : _triangles)
            for (int corner = 0; corner < 3; ++corner)
                indices->push_back(t[corner]);
        geometry.removePrimitiveSet(0, geometry.getNumPrimitiveSets());
        geometry.addPrimitiveSet(indices);
    }

private:
    template <class Vertex> void setVertices(unsigned int count, const Vertex* vertices)
    {
        _first = _vertices.size();
        for (unsigned int i = 0; i < count && vertices; ++i)
            _vertices.push_back(position(vertices[i]));
    }

    template <class Vertex> static osg::Vec3 position(const Vertex& v)
    {
        if constexpr (Vertex::num_components == 2)
            return osg::Vec3(osg::Vec3d(v.x(), v.y(), 0.0));
        else if constexpr (Vertex::num_components == 3)
            return osg::Vec3(osg::Vec3d(v.x(), v.y(), v.z()));
        else
            return osg::Vec3(osg::Vec3d(v.x(), v.y(), v.z()) / double(v.w()));
    }

    /// Adds triangles of the vertices that were set last; indices beyond them have no place.
    template <class Index> void add(GLenum mode, GLsizei count, const Index& index)
    {
        if (count <= 0) return;
        const std::size_t known = _vertices.size() - _first;
        std::vector<UVec3> added;
        const auto vertex = [&](std::size_t i)
        { return index(i) < known ? static_cast<uint32_t>(_first + index(i)) : kInvalid; };
        appendTriangles(mode, static_cast<std::size_t>(count), vertex, added);
        for (const UVec3& t : added)
            if (t.x != kInvalid && t.y != kInvalid && t.z != kInvalid) _triangles.push_back(t);
    }

    std::vector<osg::Vec3> _vertices;
    std::vector<UVec3> _triangles;
    std::size_t _first = 0; // first of the vertices that were set last
};

Reader readerOf(const osg::Drawable& drawable)
{
    Reader reader;
    if (drawable.supports(reader)) drawable.accept(reader);
    return reader;
}

uint64_t valuesHash(const osg::Geometry& geometry)
{
    uint64_t hash = bitsOf(geometry.getStateSet());
    forEachBuffer(geometry, true,
                  [&hash](const osg::BufferData* data, bool)
                  { hash = fold(hash, data ? contentsHash(*data) : 0); });
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        hash = fold(hash, set ? rangesHash(*set) : 0);
    return hash;
}

/// Returns a copy of a buffer, which is the copy that there was if that has the same values.
template <class Buffer> osg::ref_ptr<Buffer> copyOf(const Buffer* buffer, Buffer* before)
{
    if (!buffer) return nullptr;
    const bool same = before && typeid(*before) == typeid(*buffer) &&
                      contentsHash(*before) == contentsHash(*buffer);
    return same ? before : osg::clone(buffer, osg::CopyOp::DEEP_COPY_ALL);
}

template <class Buffer>
std::vector<osg::ref_ptr<Buffer>> copiesOf(const std::vector<osg::ref_ptr<Buffer>>& buffers,
                                           const std::vector<osg::ref_ptr<Buffer>>& before)
{
    std::vector<osg::ref_ptr<Buffer>> copies;
    for (std::size_t i = 0; i < buffers.size(); ++i)
        copies.push_back(
            copyOf<Buffer>(buffers[i].get(), i < before.size() ? before[i].get() : nullptr));
    return copies;
}

/// Gives the copy what tells hooks, rules and views which geometry it is.
void setIdentity(osg::Geometry& copy, const osg::Geometry& geometry)
{
    copy.setName(geometry.getName());
    copy.setNodeMask(geometry.getNodeMask());
    copy.setUserDataContainer(const_cast<osg::UserDataContainer*>(geometry.getUserDataContainer()));
}

/// Gives the copy the values of a geometry, in arrays of its own. Those that differ are new ones,
/// because the last scene may still read the others.
void setValues(osg::Geometry& copy, const osg::Geometry& geometry)
{
    copy.setStateSet(const_cast<osg::StateSet*>(geometry.getStateSet()));
    copy.setVertexArray(copyOf(geometry.getVertexArray(), copy.getVertexArray()).get());
    copy.setNormalArray(copyOf(geometry.getNormalArray(), copy.getNormalArray()).get());
    copy.setColorArray(copyOf(geometry.getColorArray(), copy.getColorArray()).get());
    copy.setTexCoordArrayList(
        copiesOf(geometry.getTexCoordArrayList(), copy.getTexCoordArrayList()));
    copy.setVertexAttribArrayList(
        copiesOf(geometry.getVertexAttribArrayList(), copy.getVertexAttribArrayList()));
    copy.setPrimitiveSetList(copiesOf(geometry.getPrimitiveSetList(), copy.getPrimitiveSetList()));
    copy.dirtyBound();
}

} // namespace

const osg::Geometry* DrawableTriangles::of(const osg::Drawable& drawable)
{
    Copy& copy = _copies[&drawable];
    if (copy.used == _round && copy.node) return copy.triangles.get();
    copy.node = &drawable;
    copy.used = _round;
    Reader reader = readerOf(drawable);
    const uint64_t hash = reader.hash();
    if (reader.empty())
        copy.triangles = nullptr;
    else if (!copy.triangles || copy.hash != hash)
    {
        if (!copy.triangles) copy.triangles = new osg::Geometry;
        reader.moveTo(*copy.triangles); // the arrays of the last scene may still be read
    }
    copy.hash = hash;
    return copy.triangles.get();
}

osg::Geometry& DrawableTriangles::chosen(const osg::Node& node, std::size_t number,
                                         const osg::Geometry& geometry)
{
    Copy& copy = _chosen[{&node, number}];
    copy.node = &node;
    copy.used = _round;
    const uint64_t hash = valuesHash(geometry);
    if (!copy.triangles || copy.hash != hash)
    {
        if (!copy.triangles) copy.triangles = new osg::Geometry;
        setValues(*copy.triangles, geometry);
    }
    setIdentity(*copy.triangles, geometry);
    copy.hash = hash;
    return *copy.triangles;
}

void DrawableTriangles::end()
{
    eraseUnused(_copies, _round);
    eraseUnused(_chosen, _round);
    isoSurfaces.end();
    mediumBoxes.end();
}

void DrawableTriangles::dropUnshared()
{
    const auto node = [](const Copy& copy) { return copy.node.get(); };
    eraseUnshared(_copies, node);
    eraseUnshared(_chosen, node);
    isoSurfaces.dropUnshared();
    mediumBoxes.dropUnshared();
}

uint64_t DrawableTriangles::hashOf(const osg::Drawable& drawable)
{
    const Reader reader = readerOf(drawable);
    return reader.empty() ? 0 : reader.hash();
}

} // namespace osgRayTrace::engine
