// ChunkFlights.h - the flights of a block of photons to the next surfaces. Layer: photons; private
// to ChunkFlights.cpp and ChunkGrids.cpp.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/ChunkTracer.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Of the collisions of a photon between two surfaces so many are stored; later ones by chance.
constexpr float kSurePoints = 8.0f;

/// Names the numbers of a stretch of a photon's way.
enum FlightDimension : uint32_t
{
    FlightLength = 0, ///< x: free flight, y: Russian roulette
    FlightPhase = 1,
    FlightKept = 2, ///< whether x: the beam, y: the collision is stored
    FlightGrid = 3, ///< a seed: flights through volumes
};

inline float largestOf(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

/// Holds the flights of a block up to the next surfaces.
struct ChunkTracer::Flights
{
    Flights(const MediumTable& m, int b) : media(m), bounce(b) {}

    const MediumTable& media;
    const int bounce;
    FloatLanes begin;              ///< where on the ray the stretch begins
    uint32_t steps[kLanes] = {};   ///< collisions
    uint32_t stretch[kLanes] = {}; ///< number of the stretch: no two have the same random numbers
    MediumId within[kLanes];
    RayPart parts[kLanes];
    SurfaceLanes surface;
    std::vector<TentativeCollision> tentative; ///< scratch

    /// Returns whether photons are beams on the stretch of a photon, but for within volumes.
    bool isThin(int i) const { return !parts[i].isEmpty() && media[within[i]].isThin(); }
    bool hasHit(int i) const { return (surface.hits >> i) & 1u; }
    bool isFront(int i) const { return (surface.front >> i) & 1u; }
    MediumId bodyAt(int i) const
    {
        return hasHit(i) ? media.interiorOf(surface.material[i]) : kOutside;
    }

    /// Returns the stretch of a photon, which has this direction, in lengths of its medium.
    MediumWay wayOf(const RayBlock& ray, Vec3 direction, int i) const
    {
        const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
        return {media[within[i]], origin, direction, parts[i]};
    }
};

} // namespace osgRayTrace::engine
