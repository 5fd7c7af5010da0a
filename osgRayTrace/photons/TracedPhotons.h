// TracedPhotons.h - what a pass of photons is asked for, and what it returns. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/BeamMap.h"
#include "osgRayTrace/photons/PhotonBlocks.h"
#include "osgRayTrace/photons/PhotonUse.h"
#include "osgRayTrace/photons/PointMap.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

struct PhotonPassOptions
{
    PhotonUse use = PhotonUse::None;
    uint32_t photons = 0; ///< number emitted in a pass
    int maxBounces = 8;   ///< most edges of a path from light to eye, without the camera ray
    uint32_t seed = 0;
    bool photonGuiding = true; ///< learn from what views see: see PhotonPasses
    uint32_t beams = 4096;     ///< number of the first photons that leave beams in media
};

inline bool operator==(const PhotonPassOptions& a, const PhotonPassOptions& b)
{
    return a.use == b.use && a.photons == b.photons && a.maxBounces == b.maxBounces &&
           a.seed == b.seed && a.photonGuiding == b.photonGuiding && a.beams == b.beams;
}

/// The way of a photon from one surface, or from its light, to the next.
struct PhotonFlight
{
    Vec3 from{0.0f}, to{0.0f}; ///< in engine space
    Vec3 normal{0.0f};   ///< geometric, unit, of the surface at the end, on the side of the photon
    float power = 0.0f;  ///< luminance, in units of the mean of all photons as they leave lights
    bool stored = false; ///< a photon was stored at the end: never straight from a light
    uint32_t before = kInvalid; ///< number of the flight that ended at the start; kInvalid: none
};

/// A point of a surface at which a view looks up photons.
struct SeenPoint
{
    Vec3 position{0.0f};
    Vec3 normal{0.0f}; ///< geometric, unit, on the side that light is gathered from
};

struct TracedPhotons
{
    PhotonBlocks photons;
    std::vector<PhotonBeam> beams;     ///< of the first photons, in media that are not dense
    std::vector<PhotonPoint> points;   ///< in dense media
    std::vector<PhotonFlight> flights; ///< if they are wanted
    uint64_t rays = 0;
    uint64_t cutWalks = 0;         ///< photons that ended within a medium: see kMostCollisions
    uint64_t openWalks = 0;        ///< walks below surfaces that have left their mesh
    uint64_t dropped = 0;          ///< photons left out because their power is not finite
    std::vector<uint32_t> emitted; ///< by bin of PhotonGuide: number of photons guided there
};

} // namespace osgRayTrace::engine
