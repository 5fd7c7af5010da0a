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
/// Tangents and w are those of the mesh or, without them, the means of VertexTangents.h; flat
/// meshes have the direction in which s grows over the triangle and the sense in which texture
/// coordinates wind around it, so that mirrored coordinates turn the bumps with them. MikkTSpace
/// leaves the interpolated tangent as long and as skew as it is; ours is made orthogonal and unit
/// at each hit. Places without an area in the texture keep their normals.
///
/// A normal that would mirror the ray into the surface is bent until it does not, by the least
/// angle [Keller17, appendix A.3]: otherwise mirrors would be black where bumps turn away from the
/// eye. Light behind the facet stays dark, as for vertex normals.
///
/// The normals before that are kept as unmappedNormal, for clear coats. Scenes without
/// SceneTraits::normalMaps need no call.
void applyNormalMaps(const TracedScene& traced, const RayHitBlock& rays, SurfaceLanes& surface);

/// Returns the normal of the clear coat at the hit of lane i, on the side of the ray: that of the
/// mesh, turned by the coat's own normal map and bent as above.
Vec3 coatNormalOf(const TracedScene& traced, const RayHitBlock& rays, const SurfaceLanes& surface,
                  int i);

} // namespace osgRayTrace::engine
