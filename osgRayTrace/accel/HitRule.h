// HitRule.h - which surfaces a ray meets. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::engine
{

/// Which partial surfaces a ray meets: see HitFilter.
struct HitRule
{
    bool culls = false;        ///< a camera ray: culled faces are not there
    bool keepsBlended = false; ///< blended surfaces are hit whatever their alpha; else by chance
    bool fromLight =
        false; ///< goes the way that light does: it meets faces of which one side is culled
    bool solid = false; ///< every surface is hit, wherever it is transparent or culled
};
constexpr HitRule kCameraRays{true, false, false, false};
constexpr HitRule kPhotonRays{false, false, true, false};

} // namespace osgRayTrace::engine
