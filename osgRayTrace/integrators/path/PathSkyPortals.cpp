// PathSkyPortals.cpp - light of the sky through openings that the session has found. Layer:
// integrators.
// SPDX-License-Identifier: MIT
//
// Where portals are known (SkyPortalFinder.h), each surface within the room takes a sample through
// them beside its sample of the sky. Both kinds of light samples have the densities p_portal and
// p_sky, and are weighted together by the balance heuristic [Veach97, eq. 9.8],
//
//   L_sky = sum over both samples of f cos L V w / (p_portal + p_sky)
//
// where w is the weight against the ray that the surface sends on, by the power heuristic with the
// sum p_portal + p_sky as the density of light samples. A sample of the sky that crosses no portal
// most likely ends at a wall, so its shadow ray is traced with probability kKept alone, and p_sky
// of such directions is kKept times that of the sky.
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/integrators/shared/SkyPortals.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr float kKept = 0.25f; ///< share of the samples of the sky beside portals

/// The portals' dimensions lie apart from those of bounces and of other samples of the sky.
constexpr uint32_t kPortalDimension = 0x40000u;

void addSamples(Tile& tile, PathBlock& block, const Bounce& bounce, LightLanes& samples)
{
    countRays(tile, block, samples.lit);
    const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
    addLight(tile, block, bounce, samples, visible, 0);
}

void shareRadiance(LightLanes& samples, int i, float share)
{
    for (FloatLanes& radiance : samples.radiance)
        radiance[i] *= share;
}

/// Weighs samples of the sky against those of the portals, and drops some that cross none.
void weighSky(const FloatLanes& sums, const FloatLanes& pdf, const FloatLanes& roulette,
              LightLanes& samples)
{
    for (const int i : lanesIn(samples.lit))
    {
        if (!(sums[i] > 0.0f)) continue;
        if (pdf[i] > 0.0f)
            samples.weight[i] = 1.0f / (1.0f / samples.weight[i] + pdf[i]);
        else if (roulette[i] < kKept)
            samples.weight[i] *= 1.0f / kKept;
        else
            samples.lit &= ~(1u << i);
    }
}

} // namespace

void samplePortals(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds)
{
    const PassContext& context = tile.context;
    const SkyPortals& portals = *context.portals;
    const PlacedEnvironment& environment = *context.traced->lights().shiningEnvironment();
    const LaneMask lanes = (bounce.diffuse | bounce.general) & ~bounce.carried;
    const LaneMask transmissive = bounce.transmissive | bounce.surface.terminatorLanes;
    const Vec3Lanes& points = bounce.surface.position;
    const bool even = context.options.environmentSampling == EnvironmentSampling::Importance &&
                      environment.isEven();
    const LaneMask onSpots = lanesOnSpots(tile, block, bounce);
    FloatLanes u, v, choice, roulette, sums, pdf;
    portals.weigh(points, sums);
    if (!even)
    {
        dimensionPoints(seeds, context.key.index,
                        bounceDimension(bounce.number, DimensionLightPoint) + kEnvironmentDimension,
                        u, v);
        dimensionPoints(seeds, context.key.index,
                        bounceDimension(bounce.number, DimensionLightChoice) +
                            kEnvironmentDimension,
                        choice, roulette);
        LightLanes samples;
        environmentLanes(context, {bounce.surface, lanes, bounce.transmissive, u, v}, 0, samples);
        portals.pdfW(points, sums, samples.wi, pdf);
        for (const int i : lanesIn(onSpots & samples.lit))
            if (pdf[i] > 0.0f)
                shareRadiance(samples, i,
                              shareBesideSpots(tile, block, bounce, i, laneOf(samples.wi, i),
                                               1.0f / samples.weight[i], pdf[i]));
        weighSky(sums, pdf, roulette, samples);
        addSamples(tile, block, bounce, samples);
    }
    dimensionPoints(seeds, context.key.index,
                    bounceDimension(bounce.number, DimensionLightPoint) + kPortalDimension, u, v);
    if (portals.rectangles().size() > 1)
        dimensionPoints(seeds, context.key.index,
                        bounceDimension(bounce.number, DimensionLightChoice) + kPortalDimension,
                        choice, roulette);
    else
        choice = {};
    LightLanes samples;
    portals.sample(points, sums, choice, u, v, samples.wi);
    portals.pdfW(points, sums, samples.wi, pdf);
    samples.lit = 0;
    for (const int i : lanesIn(lanes))
    {
        const Vec3 wi = laneOf(samples.wi, i);
        if (!(pdf[i] > 0.0f)) continue;
        if (!((transmissive >> i) & 1u) &&
            glm::dot(laneOf(bounce.surface.geometricNormal, i), wi) <= 0.0f)
            continue;
        const float pdfSky = environmentPdfW(context, environment, wi);
        setSample(samples, i, wi, environment.radiance(wi), 1.0f / (pdf[i] + pdfSky));
        if ((onSpots >> i) & 1u)
            shareRadiance(samples, i, shareBesideSpots(tile, block, bounce, i, wi, pdfSky, pdf[i]));
        setRay(samples.shadow, i, leave(bounce.surface, i, wi), wi, kInfinity);
        samples.lit |= 1u << i;
    }
    addSamples(tile, block, bounce, samples);
    sampleSunSpots(tile, block, bounce, seeds);
    if (!portals.panes().empty()) samplePaneMirrors(tile, block, bounce, seeds);
}

float skyPdfW(const Tile& tile, Vec3 from, Vec3 direction)
{
    const PassContext& context = tile.context;
    const float sky =
        environmentPdfW(context, *context.traced->lights().shiningEnvironment(), direction);
    if (!context.portals) return sky;
    const SkyPortals::Chance chance = context.portals->chanceOf(from, direction);
    if (!chance.inside) return sky;
    if (!(chance.pdfW > 0.0f)) return kKept * sky;
    return sky + chance.pdfW;
}

} // namespace osgRayTrace::engine
