// PhotonPaths.h - photons on their way, sixteen to a block. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Bodies.h"
#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/base/LargeArray.h"

namespace osgRayTrace::engine
{

/// Holds sixteen photons.
struct PhotonPathBlock
{
    Vec3Lanes origin, direction, power;
    UintLanes photon; ///< the photon's number within the pass
    UintLanes light;  ///< the light that the photon came from
    UintLanes direct; ///< 1: the path has met nothing but mirror-like surfaces yet
    // In scenes with SceneTraits::media:
    Lanes<uint64_t> bodies; ///< words of MediumStack: bodies that the rays begin in
    Lanes<int32_t> met;     ///< number of surfaces that count as edges: see ChunkFlights.cpp
    UintLanes late;         ///< number of edges that collisions add to these
    /// If flights are recorded: number of the last one in the chunk's list; kInvalid: none.
    UintLanes flight;

    MediumStack bodiesOf(int lane) const { return MediumStack(bodies[lane]); }
};

/// Holds photons in as few blocks as possible, in order. Photons that go on may be appended while
/// the blocks of the last bounce are being read: the place of a block that has been copied is free.
class PhotonPathQueue
{
public:
    /// media: paths have bodies, and count their edges. flights: they know their last flights.
    PhotonPathQueue(uint32_t capacity, bool media, bool flights)
        : _blocks((capacity + kLanes - 1) / kLanes), _media(media), _flights(flights)
    {
    }

    uint32_t size() const { return _count; }
    const PhotonPathBlock& operator[](uint32_t block) const { return _blocks[block]; }

    void clear() { _count = 0; }

    /// Appends the paths of lanes, and takes more memory if there is need.
    void append(const PhotonPathBlock& paths, LaneMask lanes);

private:
    void grow();

    UnclearedArray<PhotonPathBlock> _blocks;
    uint32_t _count = 0;
    bool _media;
    bool _flights;
};

/// Sets the two random numbers of a dimension of each lane's photon. seed: of the dimension.
void photonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& u, FloatLanes& v);

/// Sets the second of these numbers alone, at half the cost.
void secondPhotonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& v);

/// Sets the rays of a block: readyRays once for the values that all blocks have in common, loadRays
/// before each query for the rest.
void readyRays(RayHitBlock& rays);
void loadRays(const PhotonPathBlock& block, RayHitBlock& rays);

/// Holds where photons go from the surfaces that they have met, as the surface models sample it.
struct Scattered
{
    Vec3Lanes wi;       ///< unit
    Vec3Lanes weight;   ///< f cosTheta / pdfW of the sample
    LaneMask alive = 0; ///< photons of the other lanes are absorbed
    LaneMask transmitted = 0;
    LaneMask mirrored = 0; ///< lanes scattered by mirror-like lobes
};

/// Samples cosine-distributed directions around the normals, in all lanes.
void diffuseDirections(const Vec3Lanes& normal, const FloatLanes& u, const FloatLanes& v,
                       Vec3Lanes& wi);

/// Turns a block into the paths that go on from its surfaces; returns their lanes.
LaneMask leaveSurfaces(const SurfaceLanes& surface, const Vec3Lanes& normal,
                       const Scattered& scattered, const FloatLanes& roulette,
                       PhotonPathBlock& block);

} // namespace osgRayTrace::engine
