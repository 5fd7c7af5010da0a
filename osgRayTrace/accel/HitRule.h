// HitRule.h - which surfaces a ray meets. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

namespace osgRayTrace::engine
{

/// The rule that says which partial surfaces a ray meets: see HitFilter.
struct HitRule
{
    bool culls = false;        ///< camera rays: culled faces are not there
    bool keepsBlended = false; ///< blended surfaces are hit whatever their alpha; else by chance
    bool fromLight =
        false;          ///< the ray goes as light does: it meets faces of which one side is culled
    bool solid = false; ///< every surface is hit, even if it is transparent or culled
    bool passesInterfaces = false; ///< boundaries of media are not there: shadow rays
    bool subsurfaceOnly =
        false; ///< only surfaces below which light walks are there, if Embree masks rays

    /// Returns true if the ray passes what is hidden from the camera: see isHiddenFromCamera.
    constexpr bool passesHidden() const { return culls && !solid; }
};
constexpr HitRule kCameraRays{true, false, false, false, false};
constexpr HitRule kPhotonRays{false, false, true, false, false};
constexpr HitRule kShadowRays{false, false, false, false, true};

} // namespace osgRayTrace::engine
