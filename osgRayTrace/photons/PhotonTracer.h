// PhotonTracer.h - follows photons from the lights to the surfaces they are stored on. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/Photon.h"
#include "osgRayTrace/photons/PhotonEmitter.h"
#include "osgRayTrace/photons/PhotonUse.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

struct PhotonPassOptions
{
    PhotonUse use = PhotonUse::None;
    uint32_t photons = 0; ///< emitted a pass
    int maxBounces = 8;   ///< edges of a path from light to eye but for the camera ray
    uint32_t seed = 0;
    bool photonGuiding = true; ///< learn from what views see: see PhotonPasses
};

struct TracedPhotons
{
    std::vector<Photon> photons;
    uint64_t rays = 0;
    uint64_t dropped = 0;          ///< not finite: left out
    std::vector<uint32_t> emitted; ///< by bin of PhotonGuide: those that were guided there
};

/// Photons of pass number pass; the same for any number of threads. photonGuide: null, or of the
/// emitter.
TracedPhotons tracePhotons(const TracedScene& traced, const std::vector<Light>& lights,
                           const PhotonEmitter& emitter, const PhotonPassOptions& options, int pass,
                           const Workers& workers, const PhotonGuide* photonGuide = nullptr);

} // namespace osgRayTrace::engine
