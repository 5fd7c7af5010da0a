// PathLight.cpp - adds light that paths meet by chance or by light samples. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightBsdfs.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"

namespace osgRayTrace::engine
{

void countRays(Tile& tile, const PathBlock& block, LaneMask lanes)
{
    if (!tile.debug) return;
    for (const int i : lanesIn(lanes))
        tile.debug->rays[block.flagsOf(i).pixel()] += 1.0f;
}

OSGRAYTRACE_KERNEL
void dimensionPoints(const UintLanes& seeds, uint32_t passIndex, uint32_t dimension, FloatLanes& u,
                     FloatLanes& v)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float x, y;
        sobol2(passIndex, dimensionSeed(seeds[i], dimension), x, y);
        u[i] = x;
        v[i] = y;
    }
}

void addEmission(Tile& tile, const PathBlock& block, const SurfaceLanes& surface, PhotonUse use)
{
    const TracedScene& traced = *tile.context.traced;
    for (const int i : lanesIn(surface.hits))
    {
        if (!traced.materials()[surface.material[i]].emits) continue;
        const Vec3 emission = emissionTowardsRay(tile.context, block.rays, surface, i);
        if (emission == Vec3(0.0f)) continue;
        float weight = 1.0f;
        const uint32_t light = traced.surfaces()[surface.instance[i]].light;
        if (light != kInvalid && traced.lights().areaLightPmf(light) > 0.0f)
        {
            if (use == PhotonUse::Caustics && block.flagsOf(i).isOnCausticChain())
                continue; // photons carry it
            const Vec3 direction = directionOf(block.rays.ray, i);
            const float cosThetaL =
                std::fabs(glm::dot(direction, laneOf(surface.geometricNormal, i)));
            const float pdfLight =
                traced.lights().areaLightPmf(light) *
                traced.lights().pdfArea(light, block.rays.ray.tFar[i], cosThetaL);
            weight = powerHeuristic(block.pdfW[i], pdfLight);
        }
        tile.sums.add(block.flagsOf(i), laneOf(block.throughput, i) * emission * weight);
    }
}

namespace
{

/// Sets the radiance that each lane of a diffuse block gets from its light sample, in vector code.
OSGRAYTRACE_KERNEL
void diffuseLight(const Vec3Lanes& normal, const Vec3Lanes& albedo, const LightLanes& light,
                  LaneMask visible, const Vec3Lanes& throughput, bool withoutMis,
                  Vec3Lanes& radiance)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine = dot(plainOf(normal, i), plainOf(light.wi, i));
        const float positive = cosine > 0.0f ? cosine : 0.0f;
        const float pdfBsdf = positive * kInvPi;
        const float ratio = pdfBsdf * light.weight[i];
        const float mis = select(withoutMis, 1.0f, 1.0f / (1.0f + ratio * ratio));
        const float unmasked = pdfBsdf * light.weight[i] * mis;
        const float weight = select(laneBit(visible, i), unmasked, 0.0f);
        radiance.x[i] = throughput.x[i] * albedo.x[i] * light.radiance[0][i] * weight;
        radiance.y[i] = throughput.y[i] * albedo.y[i] * light.radiance[1][i] * weight;
        radiance.z[i] = throughput.z[i] * albedo.z[i] * light.radiance[2][i] * weight;
    }
}

} // namespace

void addLight(Tile& tile, const PathBlock& block, const Bounce& bounce, const LightLanes& light,
              LaneMask visible, LaneMask withoutMis)
{
    if (visible & bounce.diffuse)
    {
        Vec3Lanes radiance;
        diffuseLight(bounce.normal, bounce.albedo, light, visible & bounce.diffuse,
                     block.throughput, (visible & bounce.diffuse & withoutMis) != 0, radiance);
        for (const int i : lanesIn(visible & bounce.diffuse))
            tile.sums.add(block.flagsOf(i), laneOf(radiance, i));
    }
    const LaneMask general = visible & bounce.general;
    if (!general) return;
    Vec3Lanes fCos;
    FloatLanes pdfW;
    evalTowardsLight(block.rays.ray, bounce.surface, bounce.normal, bounce.bsdfs, light.wi, general,
                     fCos, pdfW);
    for (const int i : lanesIn(general))
    {
        if (!(pdfW[i] > 0.0f)) continue;
        const float mis =
            (withoutMis >> i) & 1u ? 1.0f : powerHeuristic(1.0f, pdfW[i] * light.weight[i]);
        const Vec3 radiance(light.radiance[0][i], light.radiance[1][i], light.radiance[2][i]);
        tile.sums.add(block.flagsOf(i), laneOf(block.throughput, i) * laneOf(fCos, i) * radiance *
                                            (light.weight[i] * mis));
    }
}

namespace
{

/// Adds a sample of one area light, which was chosen with probability pmf, for each of the lanes.
void sampleOneLight(Tile& tile, PathBlock& block, const Bounce& bounce, uint32_t light, float pmf,
                    LaneMask lanes, const FloatLanes& u, const FloatLanes& v)
{
    LightLanes samples;
    areaLightLanes(tile.context, light, pmf, {bounce.surface, lanes, bounce.transmissive, u, v},
                   samples);
    countRays(tile, block, samples.lit);
    const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
    addLight(tile, block, bounce, samples, visible, bounce.terminating);
}

/// Returns the lanes' seeds for one soft light: all soft lights are sampled, each at its own
/// points.
UintLanes seedsOfLight(const UintLanes& seeds, uint32_t light)
{
    UintLanes own;
    for (int i = 0; i < kLanes; ++i)
        own[i] = hash(seeds[i] + 0x9e3779b9u * (light + 1));
    return own;
}

} // namespace

void sampleLights(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    const LightTable& table = tile.context.traced->lights();
    const LaneMask lanes = bounce.diffuse | bounce.general;
    const UintLanes& seeds = block.seed;
    for (std::size_t k = 0; k < tile.deltaLights.size(); ++k)
    {
        const auto [index, weight] = tile.deltaLights[k];
        const Light& light = (*tile.context.lights)[index];
        FloatLanes u, v;
        if (isSoft(light))
            dimensionPoints(seedsOfLight(seeds, index), tile.context.key.index,
                            bounceDimension(bounce.number, DimensionLightPoint), u, v);
        LightLanes samples;
        deltaLightLanes(tile.context, index, {bounce.surface, lanes, bounce.transmissive, u, v},
                        samples);
        for (int i = 0; i < kLanes; ++i)
            samples.weight[i] *= weight;
        if (light.castsShadows) countRays(tile, block, samples.lit);
        addLight(tile, block, bounce, samples,
                 visibleLanes(tile.context, light, samples, tile.counts), kAllLanes);
    }
    if (table.environment()) sampleEnvironment(tile, block, bounce, seeds);
    if (table.areaLights().empty()) return;

    FloatLanes u, v;
    dimensionPoints(seeds, tile.context.key.index,
                    bounceDimension(bounce.number, DimensionLightPoint), u, v);
    if (table.areaLights().size() == 1)
    {
        sampleOneLight(tile, block, bounce, table.areaLights()[0], 1.0f, lanes, u, v);
        return;
    }
    // Lanes that chose the same light are sampled together.
    FloatLanes choice, unused;
    dimensionPoints(seeds, tile.context.key.index,
                    bounceDimension(bounce.number, DimensionLightChoice), choice, unused);
    LaneMask open = lanes;
    LightTable::Choice chosen[kLanes];
    for (const int i : lanesIn(lanes))
        chosen[i] = table.chooseAreaLight(choice[i]);
    while (open)
    {
        const LightTable::Choice& first = chosen[firstLane(open)];
        LaneMask same = 0;
        for (const int i : lanesIn(open))
            same |= static_cast<LaneMask>(chosen[i].light == first.light) << i;
        sampleOneLight(tile, block, bounce, first.light, first.pmf, same, u, v);
        open &= ~same;
    }
}

} // namespace osgRayTrace::engine
