// BufferHashes.h - hashes of arrays and primitive sets, to tell whether they have changed. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/geometry/BoundArrays.h"

#include <osg/Geometry>

#include <cstdint>

namespace osgRayTrace::engine
{

/// Names the classes of arrays and primitive sets that are read without virtual calls.
enum class BufferKind : uint8_t
{
    Vec2Array,
    Vec3Array,
    Vec4Array,
    Vec4ubArray,
    UIntElements,
    UShortElements,
    Arrays,
    Other,
};

BufferKind bufferKindOf(const osg::BufferData& data);

/// Returns a hash of the buffer's modified count, its size and the address of its data; buffers of
/// some kinds add more.
uint64_t bufferHash(BufferKind kind, const osg::BufferData& data);

/// Returns a hash of the buffer's values and of all that bufferHash covers except for the modified
/// count and the address of the data.
uint64_t contentsHash(const osg::BufferData& data);

/// Returns a hash of the vertices that a set without indices takes, whose setters mark nothing as
/// changed; 0 for other sets.
uint64_t rangesHash(const osg::PrimitiveSet& set);

/// Calls f(buffer or null, whether the buffer belongs to the shape) for each buffer that a mesh is
/// made of. attributes: vertex attributes may take the place of the fixed arrays, by a rule.
template <class F> void forEachBuffer(const osg::Geometry& geometry, bool attributes, const F& f)
{
    f(geometry.getVertexArray(), true);
    f(geometry.getNormalArray(), true);
    f(geometry.getColorArray(), false);
    for (const osg::ref_ptr<osg::Array>& array : geometry.getTexCoordArrayList())
        f(array.get(), false);
    // Position and tangents are vertex attributes that are read, as are those that rules name.
    if (attributes || !geometry.getVertexArray() || tangentArray(geometry))
        for (const osg::ref_ptr<osg::Array>& array : geometry.getVertexAttribArrayList())
            f(array.get(), false);
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        f(set.get(), true);
}

} // namespace osgRayTrace::engine
