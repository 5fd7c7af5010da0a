// VertexMap.h - which rows of the arrays of a geometry the vertices of its mesh are. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Which rows of the OSG arrays the mesh's vertices are. Needed when an array has one value for
/// each primitive set, so that a vertex of two sets becomes two.
struct VertexMap
{
    std::size_t vertexCount = 0;
    std::vector<uint32_t> rows; ///< of per-vertex arrays; empty: vertex i is row i
    std::vector<uint32_t>
        primitiveSets; ///< row of arrays that are bound per primitive set; may be empty
};

} // namespace osgRayTrace::engine
