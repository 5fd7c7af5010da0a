// PathDiscEdges.cpp - discs that reach beyond the edge of their surface. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// The photons of a disc of radius r stand for the radiance sum f power / (pi r^2) if the surface
// fills the disc. Near an edge or a corner only a share of the disc is on the surface, and the rest
// is empty. Rays from a point above the disc's centre to points of the disc tell the share: a point
// counts if its ray meets the plane of the disc there, and nothing before. Photons that such a ray
// does not reach are left out, as are those behind a thin wall.
//
// Rays are spared in pixels that are far from edges. A pixel is one of these if its first disc is
// on the surface and the pixel's corners see the plane of this disc: a pixel at the outline of a
// block may see the wall behind it first.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/PixelProjection.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kProbeHeight = 0.5f;  ///< of the point above the disc, over the disc's radius
constexpr float kLeastShare = 0.125f; ///< smaller shares are left alone: something is very near

/// Sets the lane's ray from the point above the centre of the disc to a point.
void aim(const PhotonQuery& disc, Vec3 target, int lane, float reach, RayBlock& rays)
{
    const Vec3 start = disc.position + disc.normal * (kProbeHeight * disc.radius);
    const Vec3 way = target - start;
    const float length = glm::length(way);
    setRay(rays, lane, plainOf(start), plainOf(way / length), 0.0f, length * reach);
}

/// What sixteen points of a disc meet.
struct Probe
{
    float share = 1.0f;   ///< of the disc that is on the surface
    bool blocked = false; ///< something stands on the disc
};

/// Points are spread evenly over sixteen sectors and sixteen rings, turned by chance.
Probe probe(Tile& tile, const PhotonQuery& disc, uint32_t seed)
{
    const TracedScene& traced = *tile.context.traced;
    const ShadingFrame frame(disc.normal);
    float turn, ring;
    sobol2Ordered(tile.context.key.index, dimensionSeed(seed, DimensionDiscEdge), turn, ring);
    RayHitBlock rays = {};
    for (int i = 0; i < kLanes; ++i)
    {
        const float angle = 2.0f * kPi * (static_cast<float>(i) + turn) / kLanes;
        const float share = (static_cast<float>((i * 7) % kLanes) + ring) / kLanes;
        const float radius = disc.radius * std::sqrt(share);
        const Vec3 offset =
            frame.toWorld(Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0f));
        aim(disc, disc.position + offset, i, 1.5f, rays.ray);
    }
    traced.intersector().closestHits(rays, kAllLanes, Coherence::Coherent);
    tile.counts.secondaryRays += kLanes;
    SurfaceLanes surface;
    surfacesOf(traced.surfaces(), rays, kAllLanes, surface);
    Probe result;
    int on = 0;
    for (const int i : lanesIn(surface.hits))
    {
        const float height = glm::dot(laneOf(surface.position, i) - disc.position, disc.normal);
        const bool turned =
            glm::dot(laneOf(surface.geometricNormal, i), disc.normal) < kLeastNormalCosine;
        const bool meets = std::fabs(height) <= kPlaneShare * disc.radius && !turned;
        on += meets;
        result.blocked |= !meets && height > -kPlaneShare * disc.radius;
    }
    result.share = static_cast<float>(on) / kLanes;
    return result;
}

/// Returns f times power, summed over the photons of the disc that can be seen from above it
/// [W/sr].
Vec3 seenPower(Tile& tile, const GatherLanes& points, const Bounce& bounce, int i)
{
    const PhotonMap& map = *tile.context.photons;
    const PhotonQuery disc = laneOf(points.queries, i);
    std::vector<uint32_t>& found = tile.gatherScratch.found;
    found.clear();
    map.find(disc, found);
    Vec3 power(0.0f);
    for (std::size_t first = 0; first < found.size(); first += kLanes)
    {
        const int count = static_cast<int>(std::min<std::size_t>(kLanes, found.size() - first));
        RayBlock rays = {};
        for (int k = 0; k < count; ++k)
            aim(disc, map.photon(found[first + static_cast<std::size_t>(k)]).position, k, 0.99f,
                rays);
        tile.context.traced->intersector().occlusion(rays, (1u << count) - 1u);
        tile.counts.shadowRays += static_cast<uint64_t>(count);
        for (int k = 0; k < count; ++k)
        {
            const Photon photon = map.photon(found[first + static_cast<std::size_t>(k)]);
            if (!(rays.tFar[k] > 0.0f) || (((points.directOnly >> i) & 1u) && !photon.direct))
                continue;
            power += scatterPhoton(points, bounce.albedo, bounce.diffuse, i, photon) * photon.power;
        }
    }
    return power;
}

/// Returns whether a pixel sees nothing but the plane of one of its discs, as far as its corners
/// tell. If it does not, the discs of its other surfaces may reach beyond an edge that this one is
/// far from.
bool seesPlaneAlone(Tile& tile, const PhotonQuery& disc, uint32_t pixel)
{
    const Plane plane{disc.normal, glm::dot(disc.normal, disc.position)};
    return cornersAreOn(tile, pixel, plane, disc.radius);
}

} // namespace

void correctEdges(Tile& tile, const PathBlock& block, const Bounce& bounce,
                  const PhotonQueryLanes& queries, PhotonSumLanes& sums)
{
    SeenPlane* planes = tile.result.photons.gathered->planes;
    // Caustics are seldom even up to an edge: a share of the disc tells little of their light
    // there.
    if (!planes || bounce.number > 0 || bounce.below ||
        tile.context.photonUse != PhotonUse::Indirect)
        return;
    GatherLanes points{queries, {}, bounce.bsdfs, bounce.gathering & ~bounce.rough};
    for (const int i : lanesIn(queries.lanes & ~bounce.collided))
    {
        SeenPlane& known = planes[block.flagsOf(i).pixel()];
        const bool through = !((bounce.diffuse >> i) & 1u) && bounce.bsdfs[i].scattersThrough();
        if (sums.count[i] == 0 || known.edge == DiscEdge::None || through) continue;
        const PhotonQuery disc = laneOf(queries, i);
        const Probe found = probe(tile, disc, block.seed[i]);
        if (known.edge == DiscEdge::Unknown && tile.result.photons.gathered->choosesPlanes)
            known.edge = found.share < 1.0f || !seesPlaneAlone(tile, disc, block.flagsOf(i).pixel())
                             ? DiscEdge::Near
                             : DiscEdge::None;
        if (!(found.share >= kLeastShare && found.share < 1.0f)) continue;
        setLane(points.wo, i, -directionOf(block.rays.ray, i));
        const Vec3 power =
            found.blocked ? seenPower(tile, points, bounce, i) : laneOf(sums.power, i);
        setLane(sums.power, i, power / found.share);
    }
}

} // namespace osgRayTrace::engine
