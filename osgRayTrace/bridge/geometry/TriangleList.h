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

/// An index that ends a strip, fan or polygon and begins the next one.
struct PrimitiveRestart
{
    bool on = false;
    bool atLargest = false; ///< the largest index of the type; else index
    uint32_t index = 0;

    /// One number for all of it.
    uint64_t key() const { return uint64_t(on) << 33 | uint64_t(atLargest) << 32 | index; }
    bool operator==(const PrimitiveRestart& other) const { return key() == other.key(); }
};

PrimitiveRestart restartOf(const GraphState& state);

/// All triangles in the order that OpenGL draws them. Indices into the vertex arrays, not checked.
struct TriangleList
{
    /// Set if the geometry is one triangle list of 32-bit indices: they stand there as they are
    /// needed.
    const osg::DrawElementsUInt* source = nullptr;
    std::vector<UVec3> triangles;     ///< filled if source is null
    std::vector<std::size_t> setEnds; ///< one a primitive set: end of its triangles
    ConversionCounts counts;          ///< primitive sets without triangles, and dropped triangles
    /// Of each triangle the primitive it is of, numbered as osgUtil's intersectors do; if asked
    /// for.
    std::vector<uint32_t> primitives;

    const UVec3* data() const;
    std::size_t size() const;
};

/// Whether it has triangles: they are traced.
bool hasTriangles(const osg::PrimitiveSet& set);

} // namespace osgRayTrace::engine
