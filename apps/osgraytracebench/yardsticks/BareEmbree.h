// BareEmbree.h - traces recorded rays with nothing around Embree: the yardstick. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/yardsticks/RayRecorder.h"
#include "osgRayTrace/base/Parallel.h"

namespace osgRayTrace::bench
{

/// Holds recorded rays as full packets of sixteen, loaded and traced in chunks, on all of the
/// workers' threads. The coherent flag is set as the engine sets it: on camera rays only.
class BarePackets
{
public:
    explicit BarePackets(const RecordedRays& rays);
    void trace(const engine::Workers& workers) const;

private:
    std::vector<RTCRay16> _camera, _secondary, _shadow;
    RTCScene _scene;
};

/// Traces recorded rays one at a time.
void traceSingly(const RecordedRays& rays, const engine::Workers& workers);

} // namespace osgRayTrace::bench
