// RayCones.h - how much of a surface the pixel of a ray sees. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/SurfaceLanes.h"
#include "osgRayTrace/integrators/shared/PassContext.h"

namespace osgRayTrace::engine
{

/// Ray cones [AkenineMoeller19, sect. 20.3.4]: the rays of a pixel fill a cone. Textures with mips
/// are averaged over the cone's width, so that one sample a pixel shows their mean and no texel at
/// random. Cones follow camera rays, also by way of mirrors and smooth glass, which are taken for
/// flat: a convex mirror widens cones more. A ray that leaves any other surface has no cone, and
/// reads the image itself. Only scenes with SceneTraits::mipmaps need cones.
///
/// The mean over a footprint blurs a picture that has many samples a pixel. So the cones of a pass
/// are narrower the more passes there were (PassContext::coneScale), and the blur of the mean of n
/// passes falls as log(n)/n, faster than its noise.
struct ConeLanes
{
    FloatLanes width;  ///< at the start of the ray [engine units]
    FloatLanes spread; ///< growth of the width with the distance
};

/// The cone of one ray, as in ConeLanes. By default it is a line.
struct RayCone
{
    float width = 0.0f, spread = 0.0f;
};

inline void setLane(ConeLanes& cones, int i, RayCone cone)
{
    cones.width[i] = cone.width;
    cones.spread[i] = cone.spread;
}

/// Sets the cones of camera rays: a square of this width is as large as the pixel.
void cameraCones(const PassContext& context, const RayBlock& rays, ConeLanes& cones);

/// Sets the footprints of all hits: squares of the area that the cones cut out of the surface. The
/// cones' longer width, which is what OpenGL's mips take, would blur more than it takes away noise:
/// see docs/accuracy.md.
void setFootprints(const RayBlock& rays, const ConeLanes& cones, SurfaceLanes& surface);

/// Moves the cones to the ends of the rays. Lanes that are not in mirrored get no cone.
void moveCones(const RayBlock& rays, LaneMask mirrored, ConeLanes& cones);

} // namespace osgRayTrace::engine
