// BufferHashes.h - numbers made of the values of arrays and primitive sets, to tell whether they
// have changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <cstdint>

namespace osgRayTrace::engine
{

/// Classes of arrays and primitive sets that are looked at without virtual calls.
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

/// Its modified count, its size and where its data is; of some kinds more.
uint64_t bufferHash(BufferKind kind, const osg::BufferData& data);

/// Its values, and what else bufferHash knows but for the modified count and where the data is.
uint64_t contentsHash(const osg::BufferData& data);

/// Which vertices a set without indices takes, whose setters mark nothing as changed; else 0.
uint64_t rangesHash(const osg::PrimitiveSet& set);

/// Calls f(buffer or null, whether it is of the shape) for what a mesh is made of.
template <class F> void forEachBuffer(const osg::Geometry& geometry, const F& f)
{
    f(geometry.getVertexArray(), true);
    f(geometry.getNormalArray(), true);
    f(geometry.getColorArray(), false);
    for (const osg::ref_ptr<osg::Array>& array : geometry.getTexCoordArrayList())
        f(array.get(), false);
    if (!geometry.getVertexArray())
        for (const osg::ref_ptr<osg::Array>& array : geometry.getVertexAttribArrayList())
            f(array.get(), false);
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : geometry.getPrimitiveSetList())
        f(set.get(), true);
}

} // namespace osgRayTrace::engine
