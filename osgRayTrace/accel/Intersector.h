// Intersector.h - finds what rays hit. Layer: accel. Hides Embree, packet width and ISA.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/HitRule.h"
#include "osgRayTrace/accel/RayBlock.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace osgRayTrace::engine
{

enum class Coherence
{
    Coherent,   ///< camera rays: neighbours take the same way through the BVH
    Incoherent, ///< bounces
};

class HitFilter;

struct Hit
{
    uint32_t instance = kInvalid; ///< index into Scene::instances
    uint32_t primitive = 0;
    float u = 0.0f, v = 0.0f;
    float t = kInfinity;
};

/// Thread safe. A ray that is not finite, has a zero or huge direction, or tNear > tFar or NaN is
/// not traced: it hits nothing, and is counted by the caller through the returned mask.
class Intersector
{
public:
    /// Opaque handle of an RTCScene; used by TracedScene. Rays whose origin is farther than reach
    /// from the scene's are refused. filter is kept; null: no geometry asks it.
    Intersector(void* embreeScene, int nativeWidth, float reach, const HitFilter* filter = nullptr);

    /// Closest hits of the active lanes; geometry is kInvalid in the others. Returns the lanes
    /// whose ray was refused (geometry is kInvalid there, too).
    LaneMask closestHits(RayHitBlock& block, LaneMask active, Coherence coherence,
                         HitRule rule = {}) const;

    /// Sets tFar to -infinity in the active lanes that are occluded. Refused rays count as
    /// occluded.
    LaneMask occlusion(RayBlock& block, LaneMask active) const;

    std::optional<Hit> closestHit(Vec3 origin, Vec3 direction, float tNear, float tFar,
                                  HitRule rule = {}) const;
    bool occluded(Vec3 origin, Vec3 direction, float tNear, float tFar) const;

private:
    void query(RayHitBlock& block, const Lanes<int>& valid, LaneMask active, Coherence coherence,
               HitRule rule) const;

    void* _scene;
    int _nativeWidth;
    float _reach;
    const HitFilter* _filter;
};

} // namespace osgRayTrace::engine
