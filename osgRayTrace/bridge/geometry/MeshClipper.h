// MeshClipper.h - cuts a mesh at clip planes. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Keeps the part of the mesh with (x, y, z, 1) . plane >= 0 for each plane, in the coordinates of
/// the mesh. Triangles that a plane crosses are cut; values at the cut are interpolated, and
/// neighbours share them. As in OpenGL the cut is not closed. The mesh may have no triangles
/// afterwards; each remaining triangle has an area.
///
/// The cut is made in conversion, and not by a filter on hits. Cameras, shadows, mirrors and
/// photons therefore see the same without asking, a mesh that no plane crosses stays shared and
/// pays nothing, and edges are exact. A plane that moves costs the meshes that it crosses: they are
/// cut and built again.
void clip(Mesh& mesh, const std::vector<Vec4d>& planes);

} // namespace osgRayTrace::engine
