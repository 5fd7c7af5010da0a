// NodePrints.h - numbers made of the values of a node, a light or an array, to tell whether they
// have changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/ObjectIdentity.h"

#include <osg/Geometry>
#include <osg/Group>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Classes whose values are known one by one.
enum class NodeKind : uint8_t
{
    Group,
    Switch,
    MatrixTransform,
    PositionAttitudeTransform,
    Light, ///< the last that is a group
    AreaLight,
    Environment,
    Geometry,
    Opaque, ///< any other class, with all that is below it: see graphFingerprint
};

/// By the class itself: one derived from it may do anything.
NodeKind kindOf(const osg::Node& node);

inline bool isTransform(NodeKind kind)
{
    return kind == NodeKind::MatrixTransform || kind == NodeKind::PositionAttitudeTransform;
}

inline bool isLight(NodeKind kind)
{
    return kind == NodeKind::Light || kind == NodeKind::AreaLight || kind == NodeKind::Environment;
}

/// osg::Group shows them one by one only, by virtual calls.
const osg::NodeList& childrenOf(const osg::Group& group);

/// Whether a group has this child active; masks apart.
bool isOn(NodeKind kind, const osg::Group& group, unsigned int child);

/// What decides on the matrix of a transform.
uint64_t matrixPrint(NodeKind kind, const osg::Node& node);

/// The addresses in prints are those of objects that WatchedGraph keeps alive.

/// Its state set, its children and which of them are on, its frame; of any kind but Geometry and
/// Opaque.
uint64_t nodePrint(NodeKind kind, const osg::Node& node);

/// The values of a light, its frame apart. kept: as in Digest.
uint64_t lightPrint(NodeKind kind, const osg::Node& node, KeptObjects* kept = nullptr);

/// Which arrays and primitive sets it has.
uint64_t arraysPrint(const osg::Geometry& geometry);

/// What else decides on its conversion, its state set apart.
uint64_t treatmentPrint(const osg::Geometry& geometry);

/// The hint of a node as a number: most have none.
uint8_t hintPrint(const osg::Node& node);

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
uint64_t bufferPrint(BufferKind kind, const osg::BufferData& data);

/// Its values, and what else bufferPrint knows but for the modified count and where the data is.
uint64_t contentsPrint(const osg::BufferData& data);

/// Which vertices a set without indices takes, whose setters mark nothing as changed; else 0.
uint64_t rangesPrint(const osg::PrimitiveSet& set);

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
