// RayRecorder.h - records the rays that the engine hands to Embree. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <embree3/rtcore.h>

#include <vector>

namespace osgRayTrace::bench
{

/// Holds the rays of a frame in the order in which they were traced.
struct RecordedRays
{
    std::vector<RTCRay> camera;    ///< closest-hit queries with the coherent flag
    std::vector<RTCRay> secondary; ///< the other closest-hit queries
    std::vector<RTCRay> shadow;    ///< occlusion queries
    RTCScene scene = nullptr;      ///< scene in which the rays were traced
};

/// Records the rays of this process's calls of Embree while it lives. The linker puts the recorder
/// between the engine and Embree (--wrap), so that the engine need not know of it. There may be one
/// recorder at a time, and one thread that traces: the order of rays is the order of calls.
class RayRecorder
{
public:
    explicit RayRecorder(RecordedRays& rays);
    ~RayRecorder();
    RayRecorder(const RayRecorder&) = delete;
    RayRecorder& operator=(const RayRecorder&) = delete;
};

} // namespace osgRayTrace::bench
