// PathDiscProbes.h - rays that tell where the surface under a disc ends. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/path/PathBounce.h"

namespace osgRayTrace::engine
{

inline Plane planeOf(const PhotonQuery& disc)
{
    return {disc.normal, glm::dot(disc.normal, disc.position)};
}

/// Returns the point above the disc's centre that rays start from.
Vec3 startAbove(const PhotonQuery& disc);

/// Sets rays to some points. reach: where they end, over the distance of the points.
void aimAt(PlainVec3 start, const Vec3Lanes& targets, float reach, RayBlock& rays);

/// What sixteen points of a disc tell of it.
struct DiscShare
{
    float share = 1.0f;   ///< of the disc that is on the surface
    bool blocked = false; ///< something stands on the disc
};

/// Sends sixteen rays to points of the disc, which the pass and the seed choose.
DiscShare shareOf(Tile& tile, const PhotonQuery& disc, uint32_t seed);

/// What rays tell of the edges of a disc.
struct FoundEdge
{
    DiscEdge edge = DiscEdge::Unknown; ///< None, Straight, or Unknown: there is more than one line
    Plane line;                        ///< SeenPlane::line if edge is Straight
};

/// Sends more rays over a disc around several. radius: the least of these.
FoundEdge findEdge(Tile& tile, const PhotonQuery& disc, float radius, uint32_t seed);

} // namespace osgRayTrace::engine
