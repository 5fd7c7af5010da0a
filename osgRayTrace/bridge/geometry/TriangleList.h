// TriangleList.h - the triangles of a geometry's primitive sets. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/Geometry>

#include <cstddef>
#include <vector>

namespace osgRayTrace::engine
{

/// Describes the index that ends a strip, fan or polygon and begins the next one.
struct PrimitiveRestart
{
    bool on = false;
    bool atLargest = false; ///< true: the largest index of the type; false: index
    uint32_t index = 0;

    /// Returns one number for all values.
    uint64_t key() const { return uint64_t(on) << 33 | uint64_t(atLargest) << 32 | index; }
    bool operator==(const PrimitiveRestart& other) const { return key() == other.key(); }
};

PrimitiveRestart restartOf(const GraphState& state);

/// A point, which is traced as a sphere, or a line segment, traced as a capsule: see PointSolids.h.
struct PointOrLine
{
    uint32_t from = 0, to = 0; ///< rows of the vertex arrays, not checked; equal for a point
    bool isPoint = false;
    uint32_t primitiveSet = 0;
    uint32_t primitive = 0; ///< as in TriangleList::primitives
};

/// Holds all triangles in the order in which OpenGL draws them. The indices into the vertex arrays
/// are not checked.
struct TriangleList
{
    /// Set if the geometry is one triangle list of 32-bit indices, which are used in place.
    const osg::DrawElementsUInt* source = nullptr;
    std::vector<UVec3> triangles;     ///< set if source is null
    std::vector<std::size_t> setEnds; ///< end of the triangles of each primitive set
    /// Counts of primitive sets without triangles and of dropped triangles.
    ConversionCounts counts;
    /// Primitive of each triangle, numbered as osgUtil's intersectors do; empty unless asked for.
    std::vector<uint32_t> primitives;
    std::vector<PointOrLine> solids; ///< empty unless asked for

    const UVec3* data() const;
    std::size_t size() const;
};

/// Returns whether it is known here which vertices a set draws.
bool hasIndices(const osg::PrimitiveSet& set);

/// Returns whether a set has triangles, which are then traced.
bool hasTriangles(const osg::PrimitiveSet& set);

} // namespace osgRayTrace::engine
