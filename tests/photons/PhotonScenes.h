// PhotonScenes.h - scenes that are hard for photons, in each of which path tracing converges.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/statistics/TenScenes.h"

namespace osgRayTrace::engine::test
{

/// Returns scenes of smooth-shaded coarse meshes, mirrored and uneven instances of glass, materials
/// that let a part of the light through, many lights of all kinds, and lights inside glass.
std::vector<ComparedScene> photonScenes(int width, int height);

} // namespace osgRayTrace::engine::test
