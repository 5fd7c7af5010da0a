// LightBsdfs.cpp - the light samples that surfaces of any kind scatter. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/LightBsdfs.h"

#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/shading/BsdfLanes.h"

namespace osgRayTrace::engine
{

void evalTowardsLight(const RayBlock& rays, const SurfaceLanes& surface, const Vec3Lanes& normal,
                      const Bsdf* bsdfs, const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos,
                      FloatLanes& pdfW)
{
    Vec3Lanes wo;
    for (int i = 0; i < kLanes; ++i)
        setLane(wo, i, -directionOf(rays, i));
    LaneMask reflecting = 0, alone = 0;
    for (const int i : lanesIn(lanes))
    {
        const Vec3 towards = laneOf(wi, i);
        const bool above = glm::dot(towards, laneOf(normal, i)) > 0.0f;
        if (above != isAbove(surface, i, towards)) continue;
        (bsdfs[i].transmits() || bsdfs[i].layered ? alone : reflecting) |= 1u << i;
    }
    fCos = {};
    pdfW = {};
    if (countLanes(reflecting) < kLeastBsdfLanes)
        alone |= reflecting;
    else
        evalBsdfLanes(bsdfLanes(bsdfs, reflecting), normal, wo, wi, reflecting, fCos, pdfW);
    for (const int i : lanesIn(alone))
    {
        const BsdfValue value =
            evalInWorld(bsdfs[i], laneOf(normal, i), laneOf(wo, i), laneOf(wi, i));
        setLane(fCos, i, value.fCos);
        pdfW[i] = value.pdfW;
    }
}

} // namespace osgRayTrace::engine
