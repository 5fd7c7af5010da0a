// HitShading.h - material, frame and emission of single hits, as both integrators need them.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/Bsdf.h"

namespace osgRayTrace::engine
{

inline Vec3 directionOf(const RayBlock& ray, int i)
{
    return Vec3(ray.directionX[i], ray.directionY[i], ray.directionZ[i]);
}

/// Orthonormal frame around a shading normal.
struct ShadingFrame
{
    explicit ShadingFrame(Vec3 unitNormal) : normal(unitNormal)
    {
        frameOf(normal.x, normal.y, normal.z, tangent, bitangent);
    }
    Vec3 toLocal(Vec3 w) const
    {
        return Vec3(glm::dot(w, tangent), glm::dot(w, bitangent), glm::dot(w, normal));
    }
    Vec3 toWorld(Vec3 w) const { return tangent * w.x + bitangent * w.y + normal * w.z; }

    Vec3 normal, tangent, bitangent;
};

/// evalBsdf around a shading normal, all in the world.
inline BsdfValue evalInWorld(const Bsdf& bsdf, Vec3 normal, Vec3 wo, Vec3 wi)
{
    const ShadingFrame frame(normal);
    return evalBsdf(bsdf, frame.toLocal(wo), frame.toLocal(wi));
}

/// What the options want of rays that leave smooth-shaded facets.
inline RayStart rayStart(const RenderOptions& options)
{
    return options.terminatorCorrection ? RayStart::Smooth : RayStart::Triangle;
}

/// Where a ray begins: at distance tNear from origin.
struct RayBegin
{
    Vec3 origin;
    float tNear;
};

inline void setRay(RayBlock& ray, int i, const RayBegin& begin, Vec3 direction, float tFar)
{
    setRay(ray, i, plainOf(begin.origin), plainOf(direction), begin.tNear, tFar);
}

/// Of a ray that leaves the surface towards wi: of the point itself, from where it is clear of the
/// surface, if it is steep; else of the point above. Off a large plane that one sees 0.002 % more
/// of a light.
inline RayBegin leave(const SurfaceLanes& surface, int i, Vec3 wi, const Vec3Lanes& points)
{
    const Vec3 n = laneOf(surface.geometricNormal, i);
    const float cosine = glm::dot(wi, n);
    if (std::fabs(cosine) > surface.minCosine[i])
        return {laneOf(points, i), surface.offset[i] / std::fabs(cosine)};
    const float offset = cosine >= 0.0f ? surface.offset[i] : -surface.offset[i];
    return {laneOf(points, i) + n * offset, 0.0f};
}
inline RayBegin leave(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return leave(surface, i, wi, surface.position);
}

/// True if the direction is on the ray's side of the surface as light goes: of the facet, or for
/// terminatorLanes of the shading normal alone, on whose side it must be in both cases.
inline bool isAbove(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return ((surface.terminatorLanes >> i) & 1u) ||
           glm::dot(wi, laneOf(surface.geometricNormal, i)) > 0.0f;
}

/// As leave and isAbove, but of the facet in any case: for mirror-like lobes. There is no
/// terminator in them, and what they would see from above the facet no photon could bring the other
/// way.
inline RayBegin leaveFacet(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return leave(surface, i, wi, trianglePoints(surface));
}

inline bool isAboveFacet(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return glm::dot(wi, laneOf(surface.geometricNormal, i)) > 0.0f;
}

/// Where on its material hit lane i of the block is.
MaterialPoint materialPoint(const PassContext& context, const RayHitBlock& rays,
                            const SurfaceLanes& surface, int i);

/// As of facingNormalLanes.
Vec3 facingNormal(const RayHitBlock& rays, const SurfaceLanes& surface, int i);

/// Radiance that the surface sends back along the ray by itself: 0 from the dark side of a light.
Vec3 emissionTowardsRay(const PassContext& context, const RayHitBlock& rays,
                        const SurfaceLanes& surface, int i);

/// Sets samples that are not finite to 0 and counts them.
void dropNotFinite(TileResult& result);

} // namespace osgRayTrace::engine
