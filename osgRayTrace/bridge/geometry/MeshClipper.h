// MeshClipper.h - what clip planes leave of a mesh. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Keeps what has (x, y, z, 1) . plane >= 0 for each plane, in the coordinates of the mesh.
/// Triangles that a plane crosses are cut; values at the cut are interpolated, and neighbours share
/// them. The mesh is closed as little as it is in OpenGL. Its triangles may be none afterwards;
/// each has an area.
///
/// Cut in conversion, and not by a filter on hits: so cameras, shadows, mirrors and photons see the
/// same without asking, what no plane crosses stays shared and pays nothing, and edges are exact. A
/// plane that moves costs the meshes that it crosses: they are cut and built again.
void clip(Mesh& mesh, const std::vector<Vec4d>& planes);

} // namespace osgRayTrace::engine
