// RenderOptions.h - the settings of the engine as plain data. Layer: integrators.
// The public RayTraceSettings documents them, with ranges and environment variables.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <tuple>

namespace osgRayTrace::engine
{

enum class IntegratorKind : uint8_t
{
    Automatic, ///< the cheapest that is right for the scene: see chooseIntegrator
    Whitted,
    Path,
    Ppm,            ///< photons for all indirect light, fixed hit points
    Sppm,           ///< the same, new hit points in each pass
    PhotonCaustics, ///< path tracing, photons for light that came by mirrors and glass
    Debug,
};

/// How the radius of photon lookups shrinks.
enum class RadiusSchedule : uint8_t
{
    Global, ///< by the number of the pass alone
    Local,  ///< by the photons that each pixel has seen; Ppm and Sppm only
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
    Importance, ///< in proportion to radiance, weighted against chance hits
    Structured, ///< as a few distant lights
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
    int lightSamples = 4; ///< a hit and light; rounded up to a square for the n x n strategies
    EnvironmentSampling environmentSampling = EnvironmentSampling::Importance;
    int environmentSamples = 300; ///< lights that Structured makes of the environment, at most
    int maxBounces = 8;           ///< edges of a path after the camera ray
    bool shadows = true;
    bool terminatorCorrection =
        true; ///< rays of smooth-shaded facets start as RayStart::Smooth says
    /// The first pass looks through the middles of the pixels, where first hits are sampled: for
    /// images that are filtered or upsampled by what is seen there.
    bool centredFirstPass = false;
    uint32_t seed = 0;
    int photons = 1 << 16;     ///< emitted a pass
    float photonRadius = 0.0f; ///< of the first pass [length]; 0: from the density of the photons
    float photonAlpha = 2.0f / 3.0f; ///< share of the photons of a pass that are kept
    RadiusSchedule radiusSchedule = RadiusSchedule::Global;
    bool photonGuiding =
        true; ///< photons are guided to what views see, not only at what makes caustics

    /// The options that decide on an accumulated image: all of them.
    auto restarting() const
    {
        return std::tie(integrator, lightSampling, debugChannel, lightSamples, environmentSampling,
                        environmentSamples, maxBounces, shadows, terminatorCorrection,
                        centredFirstPass, seed, photons, photonRadius, photonAlpha, radiusSchedule,
                        photonGuiding);
    }

    /// True if an accumulated image made with previous cannot be continued with *this.
    bool needsRestart(const RenderOptions& previous) const
    {
        return restarting() != previous.restarting();
    }
};

/// Samples that a hit takes of an area light: whole squares where the strategy has cells.
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
