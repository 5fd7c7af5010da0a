// RenderOptions.h - the settings of the engine as plain data. Layer: integrators.
// The public RayTraceSettings documents the settings, with ranges and environment variables.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <tuple>

namespace osgRayTrace::engine
{

enum class IntegratorKind : uint8_t
{
    Automatic, ///< the cheapest integrator that is right for the scene: see chooseIntegrator
    Whitted,
    Path,
    Ppm,            ///< photons for all indirect light, fixed hit points
    Sppm,           ///< photons for all indirect light, new hit points in each pass
    PhotonCaustics, ///< path tracing, photons for light that came by metal and glass
    Debug,
};

/// The way in which the radius of photon look-ups shrinks.
enum class RadiusSchedule : uint8_t
{
    Global, ///< shrinks by the number of the pass alone
    Local,  ///< shrinks by the photons that each pixel has seen; Ppm and Sppm only
};

enum class LightSampling : uint8_t
{
    Random,        ///< independent uniform points
    UniformJitter, ///< n x n cells, one random offset shared by all cells
    Stratified,    ///< n x n cells, one random offset for each cell
    Sobol,         ///< Owen-scrambled Sobol points, continued over passes
};

enum class EnvironmentSampling : uint8_t
{
    Importance, ///< directions in proportion to radiance, weighted against chance hits
    Structured, ///< directions of a few distant lights
    Uniform,    ///< all directions alike, weighted against chance hits
};

enum class DebugChannel : uint8_t
{
    Normal,
    Uv,
    Id,
    Albedo,
    Depth,
    Dropped,
    Cost,
};

struct RenderOptions
{
    IntegratorKind integrator = IntegratorKind::Automatic;
    LightSampling lightSampling = LightSampling::Sobol;
    DebugChannel debugChannel = DebugChannel::Normal;
    int lightSamples = 4; ///< samples of a hit and light; a square for n x n strategies, rounded up
    EnvironmentSampling environmentSampling = EnvironmentSampling::Importance;
    int environmentSamples = 300; ///< lights that Structured makes of the environment, at most
    int maxBounces = 8;           ///< edges of a path after the camera ray
    bool shadows = true;
    bool terminatorCorrection =
        true; ///< true: rays of smooth-shaded facets start as RayStart::Smooth says
    /// True: the first pass looks through the middles of the pixels, at which first hits are
    /// sampled. Images that are filtered or upsampled by their first hits need this.
    bool centredFirstPass = false;
    /// True: passes show the scene at moments of their own, so that they learn from each other
    /// nothing that holds for a moment alone.
    bool moving = false;
    /// True: the image gets many passes, so that what helps all of them is prepared before the
    /// first one. False: the first passes are shown at once.
    bool still = false;
    float aperture = 0.0f; ///< diameter of the lens of perspective views [length]; 0: a pinhole
    float focus = 0.0f; ///< distance that is seen sharp [length]; 0: that of what is straight ahead
    uint32_t seed = 0;
    int photons = 1 << 16;     ///< photons emitted in a pass
    float photonRadius = 0.0f; ///< radius in the first pass [length]; 0: from the photons' density
    float photonAlpha = 2.0f / 3.0f; ///< share of the photons of a pass that are kept
    RadiusSchedule radiusSchedule = RadiusSchedule::Global;
    int photonBeams = 4096; ///< of these photons, how many leave beams in media
    bool photonGuiding =
        true; ///< true: photons go to what views see, not only to what makes caustics

    /// Returns the options that decide on an accumulated image: all of them.
    auto restarting() const
    {
        return std::tie(integrator, lightSampling, debugChannel, lightSamples, environmentSampling,
                        environmentSamples, maxBounces, shadows, terminatorCorrection,
                        centredFirstPass, moving, still, aperture, focus, seed, photons,
                        photonRadius, photonAlpha, radiusSchedule, photonBeams, photonGuiding);
    }

    /// Returns true if an accumulated image made with previous cannot be continued with *this.
    bool needsRestart(const RenderOptions& previous) const
    {
        return restarting() != previous.restarting();
    }
};

/// Returns the number of samples that a hit takes of an area light: a square number if the strategy
/// has cells.
inline int lightSampleCount(const RenderOptions& options)
{
    const bool cells = options.lightSampling == LightSampling::UniformJitter ||
                       options.lightSampling == LightSampling::Stratified;
    if (!cells) return options.lightSamples;
    int side = 1;
    while (side * side < options.lightSamples)
        ++side;
    return side * side;
}

} // namespace osgRayTrace::engine
