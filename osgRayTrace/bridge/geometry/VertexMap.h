// VertexMap.h - the rows of a geometry's arrays that the vertices of its mesh come from. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Tells which rows of the OSG arrays the mesh's vertices come from. A map is needed if an array
/// has one value for each primitive set, so that a vertex of two sets becomes two.
struct VertexMap
{
    std::size_t vertexCount = 0;
    std::vector<uint32_t> rows; ///< rows of per-vertex arrays; empty: vertex i is row i
    std::vector<uint32_t>
        primitiveSets; ///< row of arrays that are bound per primitive set; may be empty
};

} // namespace osgRayTrace::engine
