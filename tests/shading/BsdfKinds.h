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

/// Kinds with delta lobes.
std::vector<BsdfKind> smoothKinds();

/// Both.
std::vector<BsdfKind> allKinds();

/// Unit directions above the surface, from normal to grazing.
std::vector<Vec3> outgoingDirections();

} // namespace osgRayTrace::engine::test
