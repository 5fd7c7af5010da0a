// BareEmbree.h - traces recorded rays with nothing around Embree: the yardstick. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/yardsticks/RayRecorder.h"
#include "osgRayTrace/base/Parallel.h"

#include <functional>

namespace osgRayTrace::bench
{

/// Holds recorded rays as full packets of the CPU's own width (16, 8 or 4), loaded and traced in
/// chunks, on all of the workers' threads. The coherent flag is set as the engine sets it: on
/// camera rays only.
class BarePackets
{
public:
    explicit BarePackets(const RecordedRays& rays);
    void trace(const engine::Workers& workers) const { _trace(workers); }

private:
    std::function<void(const engine::Workers&)> _trace;
};

/// Traces recorded rays one at a time.
void traceSingly(const RecordedRays& rays, const engine::Workers& workers);

} // namespace osgRayTrace::bench
