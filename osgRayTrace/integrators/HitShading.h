// HitShading.h - material, frame and emission of single hits, as both integrators need them.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/Integrator.h"
#include "osgRayTrace/sampling/Warp.h"

namespace osgRayTrace::engine
{

inline Vec3 laneOf(const Vec3Lanes& lanes, int i) { return Vec3(lanes.x[i], lanes.y[i], lanes.z[i]); }

inline void setLane(Vec3Lanes& lanes, int i, Vec3 value)
{
    lanes.x[i] = value.x;
    lanes.y[i] = value.y;
    lanes.z[i] = value.z;
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

/// Of a ray that leaves the surface towards wi: of the point itself, from where it is clear of the surface, if
/// it is steep; else of the point above. Off a large plane that one sees 0.002 % more of a light.
inline RayBegin leave(const SurfaceLanes& surface, int i, Vec3 wi)
{
    const Vec3 n = laneOf(surface.geometricNormal, i);
    const float cosine = glm::dot(wi, n);
    if (std::fabs(cosine) > surface.steep[i])
        return {laneOf(surface.position, i), surface.offset[i] / std::fabs(cosine)};
    const float offset = cosine >= 0.0f ? surface.offset[i] : -surface.offset[i];
    return {laneOf(surface.position, i) + n * offset, 0.0f};
}

/// True if the direction is on the ray's side of the surface as light goes: of the facet, or for lifted
/// lanes of the shading normal alone, on whose side it must be in both cases.
inline bool isAbove(const SurfaceLanes& surface, int i, Vec3 wi)
{
    return ((surface.lifted >> i) & 1u) || glm::dot(wi, laneOf(surface.geometricNormal, i)) > 0.0f;
}

/// Where on its material hit lane i of the block is.
MaterialPoint materialPoint(const PassContext& context, const RayHitBlock& rays,
                            const SurfaceLanes& surface, int i);

/// The shading normal turned to the side that the ray comes from; the geometric normal where the two
/// disagree so much that the ray would come from behind.
Vec3 facingNormal(const RayHitBlock& rays, const SurfaceLanes& surface, int i);

/// Radiance that the surface sends back along the ray by itself: 0 from the dark side of a light.
Vec3 emissionTowardsRay(const PassContext& context, const RayHitBlock& rays,
                        const SurfaceLanes& surface, int i);

/// facingNormal of all lanes, those without a hit included.
void facingNormalLanes(const RayBlock& ray, const SurfaceLanes& surface, Vec3Lanes& normal);

/// Sets samples that are not finite to 0 and counts them.
void dropNotFinite(TileResult& result);

} // namespace osgRayTrace::engine
