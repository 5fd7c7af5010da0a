// WhittedVolumes.h - volumes along the rays of a block. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/whitted/WhittedTile.h"
#include "osgRayTrace/media/GridRay.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Finds the volumes of VolumeLaw::Density on a ray, and widens its part by them. around: the
/// homogeneous medium of the part, if fills is true. Returns false, and no volumes, if there are
/// none.
bool findDensities(const PassContext& context, RayPart& part, const MediumRecord& around,
                   bool fills, Vec3 origin, Vec3 direction, float end,
                   std::optional<GridRay>& grids);

/// Multiplies the weight of lane i by what densities leave, and sets its air to what they emit and
/// to light, which they scatter.
void dimByDensities(const PassContext& context, ShadingBlock& block, int i, const GridRay& grids,
                    Vec3 light);

/// Puts the volumes of other laws on the rays before what is behind them, as OpenGL blends them.
void addVolumes(const WhittedTile& tile, ShadingBlock& block, LaneMask active);

} // namespace osgRayTrace::engine
