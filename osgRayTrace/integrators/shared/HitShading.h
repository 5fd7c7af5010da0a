// HitShading.h - material, frame and emission of single hits. Layer: integrators.
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

/// The orthonormal frame around a shading normal.
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

/// Returns evalBsdf around a shading normal, with all directions in world space.
inline BsdfValue evalInWorld(const Bsdf& bsdf, Vec3 normal, Vec3 wo, Vec3 wi)
{
    const ShadingFrame frame(normal);
    return evalBsdf(bsdf, frame.toLocal(wo), frame.toLocal(wi));
}

/// Returns the start that the options ask for, for rays that leave smooth-shaded facets.
inline RayStart rayStart(const RenderOptions& options)
{
    return options.terminatorCorrection ? RayStart::Smooth : RayStart::Triangle;
}

/// The begin of a ray: the point at distance tNear from origin.
struct RayBegin
{
    Vec3 origin;
    float tNear;
};

inline void setRay(RayBlock& ray, int i, const RayBegin& begin, Vec3 direction, float tFar)
{
    setRay(ray, i, plainOf(begin.origin), plainOf(direction), begin.tNear, tFar);
}

/// Returns the begin of a ray that leaves the surface towards wi. A steep ray starts from the point
/// itself, at the distance at which the ray is clear of the surface. Any other ray starts from the
/// point above the surface; off a large plane such a ray sees 0.002 % more of a light.
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

/// Returns true if the direction is on the ray's side of the surface for light: on that side of the
/// facet, or for terminatorLanes on that side of the shading normal alone. The caller must check
/// the side of the shading normal in both cases.
inline bool isAbove(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return ((surface.terminatorLanes >> i) & 1u) ||
           glm::dot(wi, laneOf(surface.geometricNormal, i)) > 0.0f;
}

/// Returns the begin as leave does, but always from the facet, for mirror-like lobes. These lobes
/// have no terminator, and no photon could take the way back to a point above the facet.
inline RayBegin leaveFacet(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return leave(surface, i, wi, trianglePoints(surface));
}

inline bool isAboveFacet(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return glm::dot(wi, laneOf(surface.geometricNormal, i)) > 0.0f;
}

/// Returns the point on its material that lane i of the block hit.
MaterialPoint materialPoint(const PassContext& context, const RayHitBlock& rays,
                            const SurfaceLanes& surface, int i);

/// Returns the normal of lane i as facingNormalLanes sets it.
Vec3 facingNormal(const RayHitBlock& rays, const SurfaceLanes& surface, int i);

/// Returns the radiance that the surface itself sends back along the ray. The dark side of a light
/// sends 0.
Vec3 emissionTowardsRay(const PassContext& context, const RayHitBlock& rays,
                        const SurfaceLanes& surface, int i);

/// Sets samples that are not finite to 0 and counts them.
void dropNotFinite(TileResult& result);

} // namespace osgRayTrace::engine
