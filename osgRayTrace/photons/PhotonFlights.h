// PhotonFlights.h - photons on their way, sixteen to a block. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Sixteen photons.
struct FlightBlock
{
    Vec3Lanes origin, direction, power;
    UintLanes photon; ///< its number within the pass
    UintLanes light;  ///< that it came from
    UintLanes direct; ///< 1: met nothing but mirror-like surfaces yet
};

/// One photon, for those that are handled one by one.
struct Flight
{
    Vec3 origin{0.0f}, direction{0.0f}, power{0.0f};
    uint32_t photon = 0;
    uint32_t light = 0;
    bool direct = true; ///< met nothing but mirror-like surfaces yet
};

/// Photons in as few blocks as possible, in order. Those that fly on may be appended to the
/// beginning of the blocks that they are taken from: a block that has been copied is free.
class FlightQueue
{
public:
    explicit FlightQueue(uint32_t capacity) : _blocks((capacity + kLanes - 1) / kLanes) {}

    uint32_t size() const { return _count; }
    const FlightBlock& operator[](uint32_t block) const { return _blocks[block]; }

    void clear() { _count = 0; }
    void append(const Flight& flight);

private:
    std::vector<FlightBlock> _blocks;
    uint32_t _count = 0;
};

/// The two numbers of a dimension of each lane's photon; seed is the dimension's.
void photonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& u, FloatLanes& v);

/// The rays of a block. What is alike for all of them has to be set once, by readyRays, and after a
/// query the rest by loadRays.
void readyRays(RayHitBlock& rays);
void loadRays(const FlightBlock& block, RayHitBlock& rays);

/// Where photons go from plain Lambert surfaces, and what is left of them: vector code.
struct DiffuseFlights
{
    Vec3Lanes origin, direction, power;
    LaneMask alive = 0; ///< the others were absorbed
};
void scatterDiffuse(const FlightBlock& block, const SurfaceLanes& surface, const Vec3Lanes& albedo,
                    const FloatLanes& u, const FloatLanes& v, const FloatLanes& roulette,
                    DiffuseFlights& scattered);

} // namespace osgRayTrace::engine
