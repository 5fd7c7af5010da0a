// PortalPanes.h - the panes that stand in openings to the sky. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/shading/RectangleLight.h"

#include <cstddef>
#include <vector>

namespace osgRayTrace::engine
{

struct PassContext;
struct TileCounts;

/// The outer side of panes: the half-space from which they mirror the sky.
struct PaneSide
{
    Vec3 normal; ///< unit, towards the sky
    float place; ///< of the panes' plane along the normal; of several planes, the innermost

    bool has(Vec3 point) const { return glm::dot(point, normal) > place; }
};

/// Returns the sides of the flat panes that rays straight through rectangles meet, one for each
/// normal. The rays are added to the counts.
std::vector<PaneSide> panesOf(const PassContext& context,
                              const std::vector<RectangleLight>& rectangles, TileCounts& counts);

/// Returns the number of the side whose panes mirror a direction at a surface; -1: none does.
int paneSideOf(const std::vector<PaneSide>& sides, Vec3 surfaceNormal, Vec3 direction);

} // namespace osgRayTrace::engine
