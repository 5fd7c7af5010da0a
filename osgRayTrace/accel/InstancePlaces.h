// InstancePlaces.h - checks and hashes of instances' transforms. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/scene/Mesh.h"

namespace osgRayTrace::engine
{

/// The largest coordinate that rays may reach, also in the local space of instances: Embree's
/// coordinates must stay below 1.8e18.
constexpr double kLargestCoordinate = 1e18;

/// Returns how far from the engine's origin a ray may start so that Embree can take the ray to the
/// instance's local space. Returns 0 if Embree, which works in float, cannot use the transform.
double reachOf(const Affine& m);

/// Returns a hash of a placement: different placements hardly ever have the same hash.
uint64_t hashOf(uint64_t serial, uint32_t instance, const Affine& m);

bool samePlace(const Instance& a, const Instance& b);

} // namespace osgRayTrace::engine
