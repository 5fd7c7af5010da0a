// PortalPanes.cpp - finds panes by rays through openings. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/PortalPanes.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/SkyPortals.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kParallel = 1.0f - 1e-6f; ///< least cosine of normals that differ by rounding only
constexpr int kMostPanes = 8;             ///< one behind the other
constexpr int kAcross = 4;                ///< rays along each side of a rectangle
static_assert(kAcross * kAcross == kLanes, "a lane for each ray");

/// Adds the side of a pane, or makes room for it in one that is there.
void addSide(Vec3 normal, Vec3 point, std::vector<PaneSide>& sides)
{
    const auto same = std::find_if(sides.begin(), sides.end(),
                                   [normal](const PaneSide& side)
                                   { return glm::dot(side.normal, normal) > kParallel; });
    if (same != sides.end())
        same->place = std::min(same->place, glm::dot(point, same->normal));
    else if (sides.size() < SkyPortals::kMost)
        sides.push_back({normal, glm::dot(point, normal)});
}

} // namespace

std::vector<PaneSide> panesOf(const PassContext& context,
                              const std::vector<RectangleLight>& rectangles, TileCounts& counts)
{
    const TracedScene& traced = *context.traced;
    std::vector<PaneSide> sides;
    for (const RectangleLight& r : rectangles)
    {
        const float reach = 0.5f * std::min(r.width, r.height);
        RayHitBlock rays;
        for (int i = 0; i < kLanes; ++i)
        {
            const float u = (static_cast<float>(i % kAcross) + 0.5f) / kAcross,
                        v = (static_cast<float>(i / kAcross) + 0.5f) / kAcross;
            const PlainVec3 on = mad(r.axisU, u * r.width, mad(r.axisV, v * r.height, r.corner));
            setRay(rays.ray, i, mad(r.normal, -reach, on), r.normal, 0.0f, 2.0f * reach);
        }
        LaneMask open = kAllLanes;
        for (int panes = 0; panes < kMostPanes && open; ++panes)
        {
            traced.intersector().closestHits(rays, open, Coherence::Coherent);
            counts.secondaryRays += static_cast<uint64_t>(countLanes(open));
            SurfaceLanes surface;
            surfacesOf(traced.surfaces(), rays, open, surface);
            open &= surface.hits;
            for (const int i : lanesIn(open))
            {
                const Vec3 normal = laneOf(surface.geometricNormal, i);
                if (traced.materials()[surface.material[i]].pane)
                    addSide(glm::dot(normal, directionOf(rays.ray, i)) > 0.0f ? normal : -normal,
                            laneOf(surface.position, i), sides);
                rays.ray.tNear[i] = std::nextafter(rays.ray.tFar[i], kInfinity);
                rays.ray.tFar[i] = 2.0f * reach;
            }
        }
    }
    return sides;
}

int paneSideOf(const std::vector<PaneSide>& sides, Vec3 surfaceNormal, Vec3 direction)
{
    for (std::size_t k = 0; k < sides.size(); ++k)
        if (std::fabs(glm::dot(surfaceNormal, sides[k].normal)) > kParallel &&
            glm::dot(direction, sides[k].normal) < 0.0f)
            return static_cast<int>(k);
    return -1;
}

} // namespace osgRayTrace::engine
