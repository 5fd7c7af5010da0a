// BsdfKinds.h - every kind of surface that the Bsdf can be, with ordinary and extreme parameters.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"
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

/// Returns kinds made by MaterialTable, as in a scene. They are white, so that a furnace shows
/// energy that is gained or lost.
std::vector<BsdfKind> roughKinds();

/// Returns metal, plastic and glass of the indices 1.0001, 1.5 and 3, from the least roughness that
/// is not smooth up to 1, from outside and inside.
std::vector<BsdfKind> extremeKinds();
/// Returns white kinds that are no metal, from outside, and also from inside if they transmit.
std::vector<BsdfKind> kindsOf(float roughness, float transmission, float ior);

/// Returns the extreme kinds below the least roughness that is not smooth, down to 0.
std::vector<BsdfKind> extremeSmoothKinds();

/// Returns kinds with delta lobes.
std::vector<BsdfKind> smoothKinds();

/// Returns rough and smooth kinds.
std::vector<BsdfKind> allKinds();

/// Returns white kinds with what LayeredBsdf.h is for: layers, thin walls, films, brushed facets
/// and leaves.
std::vector<BsdfKind> layeredKinds();

/// Returns the kind of a material, and that from inside if it transmits.
std::vector<BsdfKind> kindsOf(const std::string& name, const Material& material);

/// Returns unit directions above the surface, from normal to grazing.
std::vector<Vec3> outgoingDirections();

/// Returns directions down to 0.1 degrees above the surface.
std::vector<Vec3> grazingDirections();

} // namespace osgRayTrace::engine::test
