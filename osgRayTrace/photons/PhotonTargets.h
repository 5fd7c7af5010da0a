// PhotonTargets.h - what in a scene makes caustics, for photons to be guided to. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"

#include <vector>

namespace osgRayTrace::engine
{

struct Sphere
{
    Vec3 centre{0.0f};
    float radius = 0.0f;
};

struct PhotonTargets
{
    Sphere scene;                ///< holds all geometry
    std::vector<Sphere> spheres; ///< hold all instances that reflect like mirrors or transmit
};

/// most: spheres; more instances than that are grouped.
PhotonTargets photonTargets(const TracedScene& traced, std::size_t most);

} // namespace osgRayTrace::engine
