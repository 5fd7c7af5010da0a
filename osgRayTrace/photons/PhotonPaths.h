// PhotonPaths.h - photons on their way, sixteen to a block. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/base/LargeArray.h"

namespace osgRayTrace::engine
{

/// Sixteen photons.
struct PhotonPathBlock
{
    Vec3Lanes origin, direction, power;
    UintLanes photon; ///< its number within the pass
    UintLanes light;  ///< that it came from
    UintLanes direct; ///< 1: met nothing but mirror-like surfaces yet
};

/// Photons in as few blocks as possible, in order. Those that fly on may be appended to the
/// beginning of the blocks that they are taken from: a block that has been copied is free.
class PhotonPathQueue
{
public:
    explicit PhotonPathQueue(uint32_t capacity) : _blocks((capacity + kLanes - 1) / kLanes) {}

    uint32_t size() const { return _count; }
    const PhotonPathBlock& operator[](uint32_t block) const { return _blocks[block]; }

    void clear() { _count = 0; }

    /// The paths of lanes.
    void append(const PhotonPathBlock& paths, LaneMask lanes);

private:
    UnclearedArray<PhotonPathBlock> _blocks;
    uint32_t _count = 0;
};

/// The two numbers of a dimension of each lane's photon; seed is the dimension's.
void photonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& u, FloatLanes& v);

/// The second of them alone, which costs half.
void secondPhotonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& v);

/// The rays of a block. What is alike for all of them has to be set once, by readyRays, and after a
/// query the rest by loadRays.
void readyRays(RayHitBlock& rays);
void loadRays(const PhotonPathBlock& block, RayHitBlock& rays);

/// Where photons go from the surfaces that they met, as the surface models sampled it.
struct Scattered
{
    Vec3Lanes wi;       ///< unit
    Vec3Lanes weight;   ///< of the sample: f cosine / density
    LaneMask alive = 0; ///< the others are absorbed
    LaneMask transmitted = 0;
    LaneMask mirrored = 0; ///< by mirror-like lobes
};

/// Cosine-distributed directions around the normals, in all lanes.
void diffuseDirections(const Vec3Lanes& normal, const FloatLanes& u, const FloatLanes& v,
                       Vec3Lanes& wi);

/// Turns a block into the paths that go on from its surfaces; returns their lanes.
LaneMask leaveSurfaces(const SurfaceLanes& surface, const Vec3Lanes& normal,
                       const Scattered& scattered, const FloatLanes& roulette,
                       PhotonPathBlock& block);

} // namespace osgRayTrace::engine
