// NormalMaps.h - shading normals that textures decide on. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/accel/TracedScene.h"

namespace osgRayTrace::engine
{

/// Turns the shading normals of hits on surfaces with a normal map. The map's axes are the tangent
/// t, made orthogonal to the shading normal n, and w cross(n, t), as in MikkTSpace [Mikkelsen08].
/// Tangents and w are those of the mesh or, without them, the direction in which s grows over the
/// triangle and the sense in which texture coordinates wind around it, so that mirrored coordinates
/// turn the bumps with them. MikkTSpace has the mean of that direction over the triangles around a
/// vertex: bumps of meshes without tangents agree with it where texture coordinates do not bend
/// between triangles. Triangles without an area in the texture keep their normals.
///
/// A normal that would mirror the ray into the surface is bent until it does not, by the least
/// angle [Keller17, appendix A.3]: otherwise mirrors would be black where bumps turn away from the
/// eye. Light behind the facet stays dark, as for vertex normals.
///
/// Scenes without SceneTraits::normalMaps need no call.
void applyNormalMaps(const TracedScene& traced, const RayHitBlock& rays, SurfaceLanes& surface);

} // namespace osgRayTrace::engine
