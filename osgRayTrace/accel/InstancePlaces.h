// InstancePlaces.h - transforms of instances: whether Embree can use them, and whether two are the
// same. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/scene/Mesh.h"

namespace osgRayTrace::engine
{

/// Embree's coordinates must stay below 1.8e18, also those of rays in the local space of instances.
constexpr double kLargestCoordinate = 1e18;

/// How far from the engine's origin a ray may start so that Embree can take it to the instance's
/// local space; 0 if Embree, which does so in float, cannot use the transform.
double reachOf(const Affine& m);

/// A hash of a placement: two that are alike are hardly ever different ones.
uint64_t hashOf(uint64_t serial, uint32_t instance, const Affine& m);

bool samePlace(const Instance& a, const Instance& b);

} // namespace osgRayTrace::engine
