// BsdfKinds.h - every kind of surface that the Bsdf can be, with ordinary and extreme parameters.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/Bsdf.h"

#include <string>
#include <vector>

namespace osgRayTrace::engine::test
{

struct BsdfKind
{
    std::string name;
    Bsdf bsdf;
};

/// Made by MaterialTable, as in a scene; white, so that a furnace shows energy that is made or
/// lost.
std::vector<BsdfKind> roughKinds();

/// Metal, plastic and glass from the least roughness that is not smooth to 1, of
/// indices 1.0001, 1.5 and 3, from outside and inside.
std::vector<BsdfKind> extremeKinds();
/// White, no metal; from outside, and if it transmits from inside.
std::vector<BsdfKind> kindsOf(float roughness, float transmission, float ior);

/// The same below that roughness, down to 0.
std::vector<BsdfKind> extremeSmoothKinds();

/// Kinds with delta lobes.
std::vector<BsdfKind> smoothKinds();

/// Both.
std::vector<BsdfKind> allKinds();

/// Unit directions above the surface, from normal to grazing.
std::vector<Vec3> outgoingDirections();

/// Down to 0.1 degrees above the surface.
std::vector<Vec3> grazingDirections();

} // namespace osgRayTrace::engine::test
