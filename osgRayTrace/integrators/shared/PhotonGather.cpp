// PhotonGather.cpp - first radii, and gathering by Lambert surfaces. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/PhotonGather.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// If the largest radius holds no more photons than this, the radius comes from one look-up. If it
/// holds more, the radius is narrowed down first, by sums that need not read the photons of dense
/// cells.
constexpr std::size_t kMostDistances = 4096;
constexpr int kNarrowings = 8; ///< halvings of the octave that the radius is in

} // namespace

float radiusOf(const PhotonMap& map, PhotonQuery query, float least, float largest,
               GatherScratch& scratch)
{
    if (!(least < largest)) return largest;
    NeighbourDistances& distances = scratch.distances;
    query.radius = largest;
    if (map.findDistances(query, kMostDistances, distances))
        return std::clamp(distances.radiusOfNearest(kRadiusPhotons), least, largest);

    const auto holdsMore = [&](float radius)
    {
        query.radius = radius;
        return map.gather(query).count > kRadiusPhotons;
    };
    if (holdsMore(least)) return least;
    float few = least, many = std::min(2.0f * least, largest);
    for (; many < largest && !holdsMore(many); many = std::min(2.0f * many, largest))
        few = many;
    for (int i = 0; i < kNarrowings; ++i)
    {
        query.radius = many;
        if (map.findDistances(query, kMostDistances, distances))
            return std::clamp(distances.radiusOfNearest(kRadiusPhotons), few, many);
        const float middle = std::sqrt(few * many);
        (holdsMore(middle) ? many : few) = middle;
    }
    return many;
}

void gatherDiffuse(const PhotonMap& map, const PhotonQueryLanes& queries, const Vec3Lanes& albedo,
                   PhotonSumLanes& sums)
{
    map.gather(queries, sums);
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t in = laneBit(queries.lanes, i); // albedos of other lanes are undefined
        sums.power.x[i] = select(in, sums.power.x[i] * albedo.x[i] * kInvPi, 0.0f);
        sums.power.y[i] = select(in, sums.power.y[i] * albedo.y[i] * kInvPi, 0.0f);
        sums.power.z[i] = select(in, sums.power.z[i] * albedo.z[i] * kInvPi, 0.0f);
    }
}

} // namespace osgRayTrace::engine
