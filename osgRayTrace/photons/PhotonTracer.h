// PhotonTracer.h - follows photons from the lights to the surfaces they are stored on. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonEmitter.h"
#include "osgRayTrace/photons/TracedPhotons.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class PhotonOpenings;
class Workers;

/// Traces the photons of pass number pass, which are the same for any number of threads.
/// memory: outlives the result. photonGuide: null, or one that the emitter has learnt. openings:
/// null, or those that photons are sent through. recordsFlights: whether the flights of all photons
/// are wanted.
TracedPhotons tracePhotons(const TracedScene& traced, const std::vector<Light>& lights,
                           const PhotonEmitter& emitter, const PhotonPassOptions& options, int pass,
                           const Workers& workers, PhotonMemory& memory,
                           const PhotonGuide* photonGuide = nullptr,
                           const PhotonOpenings* openings = nullptr, bool recordsFlights = false);

} // namespace osgRayTrace::engine
