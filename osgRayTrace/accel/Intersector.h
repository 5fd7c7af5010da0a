// Intersector.h - finds what rays hit; hides Embree, packet width and ISA. Layer: accel.
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
    Coherent,   ///< camera rays, whose neighbours take the same way through the BVH, and shadow
                ///< rays from points beside each other to one light
    Incoherent, ///< bounces
};

class HitFilter;
class PaneCrossings;

struct Hit
{
    uint32_t instance = kInvalid; ///< index into Scene::instances
    uint32_t primitive = 0;
    float u = 0.0f, v = 0.0f;
    float t = kInfinity;
};

/// Traces blocks of rays. The class is thread safe. A ray is not traced if the ray is not finite,
/// has a zero or huge direction, or has tNear > tFar or NaN. Such a ray hits nothing, and the
/// caller counts the ray by the returned mask.
class Intersector
{
public:
    /// Takes an opaque handle of an RTCScene, which TracedScene has. Rays whose origin is farther
    /// than reach from the scene's origin are refused. filter is kept; null: no geometry asks the
    /// filter.
    Intersector(void* embreeScene, int nativeWidth, float reach, const HitFilter* filter = nullptr);

    /// Finds the closest hits of the active lanes; geometry is kInvalid in the other lanes. Returns
    /// the lanes whose ray was refused (their geometry is kInvalid, too).
    LaneMask closestHits(RayHitBlock& block, LaneMask active, Coherence coherence,
                         HitRule rule = {}) const;

    /// Sets tFar to -infinity in the active lanes that are occluded. Returns the lanes whose ray
    /// was refused; refused rays count as occluded. Rays pass panes and keep there where they do if
    /// crossings is not null; else panes stop them. Lanes of crossings->full() count as occluded.
    LaneMask occlusion(RayBlock& block, LaneMask active,
                       Coherence coherence = Coherence::Incoherent,
                       PaneCrossings* crossings = nullptr) const;

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
