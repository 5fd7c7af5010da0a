// PathEnvironment.cpp - adds light of the environment to paths. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Importance and Uniform sampling combine one direction a bounce with the ray that the surface sent
// on, by multiple importance sampling with the power heuristic [Veach97, sect. 9.2]. Importance
// leaves directions that are no brighter than the mean to these rays [Karlik19].
//
// Structured sampling takes the sum over all strata at the end of the camera ray, and one stratum
// by chance at later surfaces. Rays that a rough surface sent on then add no light of the
// environment; mirror-like rays add the radiance that they meet.
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

namespace osgRayTrace::engine
{

namespace
{

/// Traces the shadow rays of samples and adds the light of the visible lanes.
void addSamples(Tile& tile, PathBlock& block, const Bounce& bounce, LightLanes& samples,
                LaneMask withoutMis)
{
    countRays(tile, block, samples.lit);
    const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
    addLight(tile, block, bounce, samples, visible, withoutMis);
}

/// Adds a sample of one stratum for each lane. All strata are equally likely, as each stratum
/// stands for about the same share of the light.
void sampleOneStratum(Tile& tile, PathBlock& block, const Bounce& bounce, LaneMask lanes,
                      const FloatLanes& u)
{
    const std::vector<EnvironmentStratum>& strata = *tile.context.strata;
    const auto count = static_cast<uint32_t>(strata.size());
    uint32_t chosen[kLanes];
    for (int i = 0; i < kLanes; ++i)
        chosen[i] = std::min(static_cast<uint32_t>(u[i] * static_cast<float>(count)), count - 1);
    LightLanes samples;
    samples.lit = 0;
    LaneMask lit = 0;
    for (const int i : lanesIn(lanes))
    {
        stratumLanes(strata[chosen[i]], static_cast<float>(count), bounce.surface, 1u << i,
                     bounce.transmissive, samples);
        lit |= samples.lit;
    }
    samples.lit = lit;
    addSamples(tile, block, bounce, samples, kAllLanes);
}

} // namespace

void sampleEnvironment(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds)
{
    if (!tile.context.traced->lights().shiningEnvironment()) return;
    const LaneMask lanes = (bounce.diffuse | bounce.general) & ~bounce.carried;
    if (tile.context.portals)
    {
        samplePortals(tile, block, bounce, seeds);
        return;
    }
    if (tile.sky.active && bounce.number == 0) addSkyRays(tile, block, bounce);
    LightLanes samples;
    if (tile.context.strata && bounce.number == 0)
    {
        for (const EnvironmentStratum& stratum : *tile.context.strata)
        {
            stratumLanes(stratum, 1.0f, bounce.surface, lanes, bounce.transmissive, samples);
            addSamples(tile, block, bounce, samples, kAllLanes);
        }
        return;
    }
    FloatLanes u, v;
    dimensionPoints(seeds, tile.context.key.index,
                    bounceDimension(bounce.number, DimensionLightPoint) + kEnvironmentDimension, u,
                    v);
    if (tile.context.strata)
    {
        sampleOneStratum(tile, block, bounce, lanes, u);
        return;
    }
    const bool importance =
        tile.context.options.environmentSampling == EnvironmentSampling::Importance;
    if (importance && tile.context.traced->lights().environment()->isEven() && !bounce.terminating)
        return; // rays that find the sky by chance have all of its light
    environmentLanes(tile.context, {bounce.surface, lanes, bounce.transmissive, u, v},
                     bounce.terminating, samples);
    addSamples(tile, block, bounce, samples, bounce.terminating);
}

void addEnvironment(Tile& tile, const PathBlock& block, LaneMask missed, int number, PhotonUse use)
{
    const PlacedEnvironment* environment = tile.context.traced->lights().shiningEnvironment();
    if (number == 0 && !visibleEnvironment(tile.context))
        return; // integrators do not add the clear colour
    for (const int i : lanesIn(missed))
    {
        const PathFlags path = block.flagsOf(i);
        const Vec3 throughput = laneOf(block.throughput, i);
        if (number == 0) tile.sums.a[path.pixel()] = 1.0f;
        if (!path.isScattered())
        {
            tile.sums.add(path, throughput * radianceBehind(tile.context, block.rays.ray, i));
            continue;
        }
        if (!environment) continue;         // a backdrop gives no light
        if (path.isMirroredSky()) continue; // sampled before the pane
        if (use != PhotonUse::None && path.isOnCausticChain()) continue; // photons carry it
        const bool sampled = block.pdfW[i] < kInfinity;
        if (sampled && tile.context.strata) continue; // strata hold all of its light
        const RayBlock& ray = block.rays.ray;
        const Vec3 direction = directionOf(ray, i);
        const Vec3 from(ray.originX[i], ray.originY[i], ray.originZ[i]);
        const float weight =
            sampled ? powerHeuristic(block.pdfW[i], skyPdfW(tile, from, direction)) : 1.0f;
        const float share = sampled ? shareOfSky(tile, path, number) : 1.0f;
        tile.sums.add(path, throughput * environment->radiance(direction) * (weight * share));
    }
}

} // namespace osgRayTrace::engine
