// SegmentLights.h - light that a medium scatters towards a ray, from all lights. Layer:
// integrators.
// SPDX-License-Identifier: MIT
//
// Single scattering along a stretch of a ray is
//
//   L = integral over t of T(t) sigmaS p(w, wi) integral over lights of L_i V T_shadow dw_i dt
//
// It is estimated with one point of the stretch for each light. Lights at a place take the point by
// Equiangular, so that their falloff drops out; lights that are far away, or that do not fade, take
// it as a free flight would collide. What collides on a walk therefore carries indirect light only.
#pragma once

#include "osgRayTrace/integrators/shared/MediumNumbers.h"
#include "osgRayTrace/integrators/shared/MediumRays.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/integrators/shared/TileResult.h"
#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/media/MediumWay.h"

#include <optional>

namespace osgRayTrace::engine
{

/// The volumes on the stretches of the rays of a block; nothing where there are none.
using GridLanes = Lanes<std::optional<GridRay>>;

/// Stretches of the rays of a block within media that scatter.
struct MediumSegments
{
    const RayBlock* ray = nullptr;
    LaneMask lanes = 0;
    RayPart parts[kLanes];
    MediumId media[kLanes];
    MediumLanes bodies;   ///< of the stretches
    Vec3Lanes throughput; ///< of a ray at the begin of its stretch
    MediumNumbers numbers[kLanes];
    const GridLanes* grids = nullptr; ///< null: the scene has no volumes
    bool eachLight = true;            ///< false: one of the delta lights stands for all
    bool withMis = true; ///< the sky is also found by collisions, and weighted against them

    /// Returns the volumes on the stretch of lane i; null if there are none. The part of the lane
    /// is then their extent, and includes what the homogeneous medium fills.
    const GridRay* gridsOf(int i) const { return grids && (*grids)[i] ? &*(*grids)[i] : nullptr; }

    /// Returns the stretch of lane i, which this medium alone fills.
    MediumWay wayOf(int i, const MediumRecord& medium) const;

    /// Returns its length at full density.
    float lengthOf(int i, const MediumRecord& medium) const
    {
        return medium.thins ? wayOf(i, medium).length() : parts[i].end - parts[i].begin;
    }

    /// Returns where on the ray so much of that length lies behind.
    float distanceAt(int i, const MediumRecord& medium, float length) const
    {
        return medium.thins ? wayOf(i, medium).distanceAt(length) : parts[i].begin + length;
    }
};

/// Returns the probability with which a free flight through the stretch of lane i collides. Within
/// volumes, where lights take places by flights that need not collide, it counts as 1.
float collisionProbability(const PassContext& context, const MediumSegments& segments, int i);

/// Adds to radiance what the stretches scatter of the light of all lights, times throughput. Counts
/// shadow rays.
void addSegmentLights(const PassContext& context, const SampledLights& deltaLights,
                      const MediumSegments& segments, TileCounts& counts, Vec3Lanes& radiance);

} // namespace osgRayTrace::engine
