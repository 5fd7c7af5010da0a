// PhotonTargets.h - the parts of a scene that make caustics: photons are guided to them. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/photons/PhotonUse.h"

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
    std::vector<Sphere> spheres; ///< together hold all instances that make caustics
};

/// Finds the targets of a scene: what mirrors or transmits, and for PhotonUse::Caustics also what
/// is glossy. With PhotonUse::Indirect glossy targets cost more time than they take off the error.
/// most: number of spheres; if there are more instances, neighbours share spheres.
PhotonTargets photonTargets(const TracedScene& traced, PhotonUse use, std::size_t most);

} // namespace osgRayTrace::engine
