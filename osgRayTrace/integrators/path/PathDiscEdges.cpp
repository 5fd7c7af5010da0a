// PathDiscEdges.cpp - discs that reach beyond the edge of their surface. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// The photons of a disc of radius r stand for the radiance sum f power / (pi r^2) if the surface
// fills the disc. Near an edge or a corner only a share of the disc is on the surface, and the rest
// is empty. Rays from a point above the disc's centre to points of the disc tell the share: a point
// counts if its ray meets the plane of the disc there, and nothing before. Photons that such a ray
// does not reach are left out, as are those behind a thin wall.
//
// Rays are spared where the first photons of a block of pixels have been looked up: rays over all
// of these discs together tell that no edge is near, or that the only one is straight, where a wall
// stands on the surface. The share of a disc on one side of a line needs no rays. Pixels remember
// the plane that this is known of. Hits on other surfaces, which a pixel at the outline of a block
// may see later, send rays of their own.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathDiscProbes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kLeastShare = 0.125f; ///< smaller shares are left alone: something is very near

/// Discs are looked at together if so many of them are on one plane, and if the disc around them
/// all is no larger than so many of the smallest one.
constexpr int kLeastTogether = 4;
constexpr float kLargestTogether = 4.0f;

/// Discs are on one plane if their normals have this cosine at least, and if their centres are off
/// the plane by no more than this share of the radius.
constexpr float kSameCosine = 0.9999f, kSamePlane = 1e-3f;

/// Returns the disc around the discs of some lanes, which are on one plane.
PhotonQuery discAround(const PhotonQueryLanes& queries, LaneMask lanes)
{
    PhotonQuery disc = laneOf(queries, firstLane(lanes));
    Vec3 sum(0.0f);
    for (const int i : lanesIn(lanes))
        sum += laneOf(queries.position, i) - disc.position;
    disc.position += sum / static_cast<float>(countLanes(lanes));
    disc.radius = 0.0f;
    for (const int i : lanesIn(lanes))
        disc.radius =
            std::max(disc.radius,
                     queries.radius[i] + glm::length(laneOf(queries.position, i) - disc.position));
    return disc;
}

/// Tells the edges of some lanes' discs, which are on one plane, if there are none, or a straight
/// one. Leaves them unknown if not. Returns whether there are others.
bool decideTogether(Tile& tile, const PathBlock& block, const PhotonQueryLanes& queries,
                    LaneMask lanes)
{
    float least = kInfinity;
    for (const int i : lanesIn(lanes))
        least = std::min(least, queries.radius[i]);
    const PhotonQuery disc = discAround(queries, lanes);
    if (!(disc.radius <= kLargestTogether * least)) return false;
    const FoundEdge found = findEdge(tile, disc, least, block.seed[firstLane(lanes)]);
    if (found.edge == DiscEdge::Unknown) return true;
    for (const int i : lanesIn(lanes))
    {
        SeenPlane& known = tile.result.photons.gathered->planes[block.flagsOf(i).pixel()];
        known.plane = planeOf(disc);
        known.line = found.line;
        known.edge = found.edge;
    }
    return false;
}

/// Decides for those of the lanes whose discs are on planes with enough others. Returns those near
/// edges that are not straight, which it leaves unknown.
LaneMask decideInGroups(Tile& tile, const PathBlock& block, const PhotonQueryLanes& queries,
                        LaneMask lanes)
{
    LaneMask near = 0;
    while (lanes)
    {
        const int first = firstLane(lanes);
        const Vec3 normal = laneOf(queries.normal, first);
        const Plane plane{normal, glm::dot(normal, laneOf(queries.position, first))};
        LaneMask group = 0;
        for (const int i : lanesIn(lanes))
            if (glm::dot(normal, laneOf(queries.normal, i)) > kSameCosine &&
                std::fabs(heightAbove(plane, laneOf(queries.position, i))) <=
                    kSamePlane * queries.radius[first])
                group |= 1u << i;
        group |= 1u << first;
        lanes &= ~group;
        if (countLanes(group) >= kLeastTogether && decideTogether(tile, block, queries, group))
            near |= group;
    }
    return near;
}

/// Takes out of found the photons that cannot be seen from above the disc's centre.
void dropHidden(Tile& tile, const PhotonQuery& disc, std::vector<uint32_t>& found)
{
    const PhotonMap& map = *tile.context.photons;
    std::size_t kept = 0;
    for (std::size_t first = 0; first < found.size(); first += kLanes)
    {
        const int count = static_cast<int>(std::min<std::size_t>(kLanes, found.size() - first));
        Vec3Lanes targets = {};
        RayBlock rays;
        for (int k = 0; k < count; ++k)
            setLane(targets, k, map.position(found[first + static_cast<std::size_t>(k)]));
        aimAt(plainOf(startAbove(disc)), targets, 0.99f, rays);
        tile.context.traced->intersector().occlusion(rays, (1u << count) - 1u);
        tile.counts.shadowRays += static_cast<uint64_t>(count);
        for (int k = 0; k < count; ++k)
            if (rays.tFar[k] > 0.0f) found[kept++] = found[first + static_cast<std::size_t>(k)];
    }
    found.resize(kept);
}

/// Takes out of found the photons beyond a line.
void dropBeyond(const PhotonMap& map, const Plane& line, std::vector<uint32_t>& found)
{
    const auto isBeyond = [&](uint32_t k) { return heightAbove(line, map.position(k)) > 0.0f; };
    found.erase(std::remove_if(found.begin(), found.end(), isBeyond), found.end());
}

/// What is corrected: the discs of some lanes and the sums over their photons.
struct Discs
{
    const PathBlock& block;
    const Bounce& bounce;
    const PhotonQueryLanes& queries;
    PhotonSumLanes& sums;
};

/// Sets the sum of lane i to that of the photons that drop(found) leaves, over the share of the
/// disc that is on the surface.
template <class Drop>
void correct(Tile& tile, const Discs& discs, int i, float share, const Drop& drop)
{
    const PhotonMap& map = *tile.context.photons;
    std::vector<uint32_t>& found = tile.gatherScratch.found;
    found.clear();
    map.find(laneOf(discs.queries, i), found);
    const std::size_t all = found.size();
    drop(found);
    Vec3 power = laneOf(discs.sums.power, i);
    if (found.size() < all)
    {
        const Bounce& bounce = discs.bounce;
        GatherLanes points{discs.queries, {}, bounce.bsdfs, bounce.gathering & ~bounce.rough};
        setLane(points.wo, i, -directionOf(discs.block.rays.ray, i));
        power = Vec3(0.0f);
        for (const uint32_t k : found)
        {
            const Photon photon = map.photon(k);
            if (((points.directOnly >> i) & 1u) && !photon.direct) continue;
            power += scatterPhoton(points, bounce.albedo, bounce.diffuse, i, photon) * photon.power;
        }
    }
    setLane(discs.sums.power, i, power / share);
}

/// Returns the share of a disc's area that is before a line at this distance from the centre, over
/// the radius: from -1 to 1, and negative if the centre is beyond.
float shareBefore(float distance)
{
    return 1.0f - (std::acos(distance) - distance * std::sqrt(1.0f - distance * distance)) * kInvPi;
}

/// Corrects the discs of some lanes that end at straight lines.
void correctAtLines(Tile& tile, const Discs& discs, LaneMask lanes)
{
    const auto lineOf = [&](int i) -> const Plane&
    { return tile.result.photons.gathered->planes[discs.block.flagsOf(i).pixel()].line; };
    PhotonQueryLanes cut = discs.queries;
    cut.lanes = 0;
    FloatLanes share;
    for (const int i : lanesIn(lanes))
    {
        const float distance = -heightAbove(lineOf(i), laneOf(cut.position, i)) / cut.radius[i];
        if (!(distance < 1.0f)) continue;
        share[i] = shareBefore(std::max(distance, 0.0f));
        cut.lanes |= 1u << i;
    }
    if (!cut.lanes) return;
    const PhotonMap& map = *tile.context.photons;
    std::vector<FoundPhoton>& found = tile.gatherScratch.foundLanes;
    found.clear();
    map.find(cut, found);
    LaneMask beyond = 0; // lanes that have photons there
    for (const FoundPhoton& f : found)
        for (const int i : lanesIn(f.lanes & ~beyond))
            if (heightAbove(lineOf(i), map.position(f.photon)) > 0.0f) beyond |= 1u << i;
    for (const int i : lanesIn(cut.lanes))
        if ((beyond >> i) & 1u)
            correct(tile, discs, i, share[i],
                    [&](std::vector<uint32_t>& photons) { dropBeyond(map, lineOf(i), photons); });
        else
            setLane(discs.sums.power, i, laneOf(discs.sums.power, i) / share[i]);
}

/// Corrects a disc by what rays tell of it. Returns the share of it that is on the surface.
float correctByRays(Tile& tile, const Discs& discs, int i)
{
    const PhotonQuery disc = laneOf(discs.queries, i);
    const DiscShare found = shareOf(tile, disc, discs.block.seed[i]);
    if (!(found.share >= kLeastShare && found.share < 1.0f)) return found.share;
    if (found.blocked)
        correct(tile, discs, i, found.share,
                [&](std::vector<uint32_t>& photons) { dropHidden(tile, disc, photons); });
    else
        setLane(discs.sums.power, i, laneOf(discs.sums.power, i) / found.share);
    return found.share;
}

} // namespace

void correctEdges(Tile& tile, const PathBlock& block, const Bounce& bounce,
                  const PhotonQueryLanes& queries, PhotonSumLanes& sums)
{
    const GatheredPhotons& gathered = *tile.result.photons.gathered;
    SeenPlane* planes = gathered.planes;
    // Caustics are seldom even up to an edge: a share of the disc tells little of their light
    // there.
    if (!planes || bounce.number > 0 || bounce.below ||
        tile.context.photonUse != PhotonUse::Indirect)
        return;
    LaneMask lanes = 0, unknown = 0;
    for (const int i : lanesIn(queries.lanes & ~bounce.collided))
    {
        const bool through = !((bounce.diffuse >> i) & 1u) && bounce.bsdfs[i].scattersThrough();
        if (sums.count[i] == 0 || through) continue;
        lanes |= 1u << i;
        if (planes[block.flagsOf(i).pixel()].edge == DiscEdge::Unknown) unknown |= 1u << i;
    }
    LaneMask near = 0;
    if (unknown && gathered.choosesPlanes) near = decideInGroups(tile, block, queries, unknown);
    const Discs discs{block, bounce, queries, sums};
    LaneMask straight = 0;
    for (const int i : lanesIn(lanes))
    {
        SeenPlane& known = planes[block.flagsOf(i).pixel()];
        const bool isKnown = known.edge == DiscEdge::None || known.edge == DiscEdge::Straight;
        if (isKnown && isOn(known.plane, queries.radius[i], laneOf(queries.position, i),
                            laneOf(queries.normal, i)))
        {
            if (known.edge == DiscEdge::Straight) straight |= 1u << i;
            continue;
        }
        const float share = correctByRays(tile, discs, i);
        if (known.edge != DiscEdge::Unknown || !gathered.choosesPlanes) continue;
        // Near an edge that others have found, sixteen rays may miss it.
        const bool isNear = share < 1.0f || ((near >> i) & 1u);
        known.edge = isNear ? DiscEdge::Near : DiscEdge::None;
        known.plane = planeOf(laneOf(queries, i));
    }
    if (straight) correctAtLines(tile, discs, straight);
}

} // namespace osgRayTrace::engine
