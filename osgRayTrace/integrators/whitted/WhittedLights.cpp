// WhittedLights.cpp - light from lights of all kinds, sample by sample. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/LightBsdfs.h"
#include "osgRayTrace/integrators/whitted/WhittedTile.h"

namespace osgRayTrace::engine
{

void countRays(WhittedTile& tile, const ShadingBlock& block, LaneMask lanes)
{
    if (!tile.result.debug) return;
    for (const int i : lanesIn(lanes))
        tile.result.debug->rays[block.pixel[i]] += 1.0f;
}

void drawFirstPoints(const WhittedTile& tile, ShadingBlock& block)
{
    if (tile.areaLights.empty()) return;
    tile.areaGrid.draw(0, 0, block.seed, block.firstU, block.firstV);
}

namespace
{

/// Rectangles are sampled by solid angle from this one on [sr]: with kWideAngle most of the Cornell
/// box would be, and a frame would take 1.16 times as long.
constexpr float kLeastAngle = 0.2f;

/// Adds f cos L V / pdfW of Lambert lanes in vector code.
OSGRAYTRACE_KERNEL
void addDiffuse(const Vec3Lanes& normal, const Vec3Lanes& albedo, const LightLanes& light,
                LaneMask visible, float scale, Vec3Lanes& sum)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine = dot(plainOf(normal, i), plainOf(light.wi, i));
        const uint32_t use = laneBit(visible, i) & maskOf(cosine > 0.0f);
        // Lanes that are not used may hold anything. The selection comes last, so that nothing of
        // such a lane gets through.
        const float weight = cosine * light.weight[i] * (scale * kInvPi);
        const float r = albedo.x[i] * light.radiance[0][i] * weight;
        const float g = albedo.y[i] * light.radiance[1][i] * weight;
        const float b = albedo.z[i] * light.radiance[2][i] * weight;
        sum.x[i] += select(use, r, 0.0f);
        sum.y[i] += select(use, g, 0.0f);
        sum.z[i] += select(use, b, 0.0f);
    }
}

/// Adds f cos L V / pdfW of lanes with any other Bsdf.
void addGeneral(ShadingBlock& block, const LightLanes& light, LaneMask visible, float scale)
{
    Vec3Lanes fCos;
    FloatLanes pdfW;
    evalTowardsLight(block.rays.ray, block.surface, block.materials.normal, block.materials.bsdfs,
                     light.wi, visible, fCos, pdfW);
    for (const int i : lanesIn(visible))
    {
        const Vec3 radiance(light.radiance[0][i], light.radiance[1][i], light.radiance[2][i]);
        addLane(block.radiance, i, laneOf(fCos, i) * radiance * (light.weight[i] * scale));
    }
}

} // namespace

void addSampledLight(ShadingBlock& block, const LightLanes& samples, LaneMask visible, float scale)
{
    const LaneMaterials& m = block.materials;
    if (visible & m.diffuse)
        addDiffuse(m.normal, m.albedo, samples, visible & m.diffuse, scale, block.radiance);
    if (visible & ~m.diffuse) addGeneral(block, samples, visible & ~m.diffuse, scale);
}

void addFixedFunctionLight(ShadingBlock& block, const LightLanes& samples, const Light& light,
                           int i, float share, float weight)
{
    FixedFunctionPoint& point = block.materials.points[i];
    const float attenuation = samples.attenuation[i] * share;
    if (!((samples.tinted >> i) & 1u))
    {
        addLight(point, light, laneOf(samples.wi, i), attenuation, weight);
        return;
    }
    Light tinted = light; // OpenGL's colours, as they come through panes
    tinted.diffuse *= laneOf(samples.tint, i);
    tinted.specular *= laneOf(samples.tint, i);
    addLight(point, tinted, laneOf(samples.wi, i), attenuation, weight);
}

namespace
{

/// Takes one light sample through its stages for all blocks. draw sets block.light for the lanes of
/// a mask.
template <class Draw>
void addSample(WhittedTile& tile, ShadingBlock* blocks, int count, Coherence coherence, float scale,
               const Draw& draw)
{
    for (ShadingBlock* block = blocks; block != blocks + count; ++block)
    {
        const LaneMaterials& m = block->materials;
        draw(*block, m.diffuse | m.physical | m.fixedFunction);
    }
    for (ShadingBlock* block = blocks; block != blocks + count; ++block)
    {
        countRays(tile, *block, block->light.lit);
        block->light.lit = visibleLanes(tile.context, block->light, tile.result.counts, coherence);
        if (tile.context.traced->traits().media) dimSamples(tile, block->light.lit, block->light);
    }
    for (ShadingBlock* block = blocks; block != blocks + count; ++block)
        addSampledLight(*block, block->light, block->light.lit, scale);
}

/// Adds direct light from the area lights of the pass, sample by sample.
void addAreaLights(WhittedTile& tile, ShadingBlock* blocks, int count)
{
    const PassContext& context = tile.context;
    const SampledLights& lights = tile.areaLights;
    const LightGrid& grid = tile.areaGrid;
    for (std::size_t k = 0; k < lights.size(); ++k)
    {
        const float scale = lights[k].weight / static_cast<float>(grid.samples());
        for (uint32_t j = 0; j < grid.samples(); ++j)
        {
            addSample(tile, blocks, count, Coherence::Coherent, scale,
                      [&](ShadingBlock& block, LaneMask lanes)
                      {
                          FloatLanes u = block.firstU, v = block.firstV;
                          if (k + j > 0) grid.draw(k, j, block.seed, u, v);
                          areaLightLanes(context, lights[k].light, 1.0f,
                                         {block.surface, lanes, block.materials.transmissive, u, v},
                                         block.light, kLeastAngle);
                      });
        }
    }
}

/// Adds direct light from the environment: as many samples as an area light gets, or one sample of
/// each stratum.
void addEnvironment(WhittedTile& tile, ShadingBlock* blocks, int count)
{
    const PassContext& context = tile.context;
    if (context.strata)
    {
        for (const EnvironmentStratum& stratum : *context.strata)
            addSample(tile, blocks, count, Coherence::Coherent, 1.0f,
                      [&](ShadingBlock& block, LaneMask lanes) {
                          stratumLanes(stratum, 1.0f, block.surface, lanes,
                                       block.materials.transmissive, block.light);
                      });
        return;
    }
    const LightGrid& grid = tile.areaGrid;
    const std::size_t behindAreaLights = tile.areaLights.size();
    for (uint32_t j = 0; j < grid.samples(); ++j)
        addSample(tile, blocks, count, Coherence::Incoherent,
                  1.0f / static_cast<float>(grid.samples()),
                  [&](ShadingBlock& block, LaneMask lanes)
                  {
                      FloatLanes u, v;
                      grid.draw(behindAreaLights, j, block.seed, u, v);
                      environmentLanes(context,
                                       {block.surface, lanes, block.materials.transmissive, u, v},
                                       kAllLanes, block.light);
                  });
}

/// Adds one sample of one delta light. share is the factor of the sample.
void addDeltaLight(WhittedTile& tile, ShadingBlock& block, uint32_t index, float share,
                   const FloatLanes& u, const FloatLanes& v)
{
    const PassContext& context = tile.context;
    const Light& light = (*context.lights)[index];
    const LaneMaterials& m = block.materials;
    LightLanes& samples = block.light;
    deltaLightLanes(context, index,
                    {block.surface, m.diffuse | m.physical | m.fixedFunction, m.transmissive, u, v},
                    samples);
    // Fixed-function lanes that face away get only the light's ambient term, and no shadow ray is
    // traced for them.
    const LaneMask reached = samples.lit;
    for (const int i : lanesIn(samples.lit & m.fixedFunction))
        if (glm::dot(m.points[i].normal, laneOf(samples.wi, i)) <= 0.0f) samples.lit &= ~(1u << i);
    if (light.castsShadows) countRays(tile, block, samples.lit);
    const LaneMask visible =
        visibleLanes(context, light, samples, tile.result.counts, Coherence::Coherent);
    if (context.traced->traits().media) dimSamples(tile, visible, samples);
    for (const int i : lanesIn(reached & m.fixedFunction))
        addFixedFunctionLight(block, samples, light, i, share,
                              (visible >> i) & 1u ? samples.weight[i] : 0.0f);
    addSampledLight(block, samples, visible & ~m.fixedFunction, share);
}

/// Adds the light of the delta lights of the pass. Lights with a size take as many samples as area
/// lights do; the numbers of their points follow those of the area lights and of the environment.
void addDeltaLights(WhittedTile& tile, ShadingBlock& block)
{
    const LightTable& table = tile.context.traced->lights();
    std::size_t number = tile.areaLights.size() + (table.shiningEnvironment() ? 1 : 0);
    FloatLanes u, v;
    for (std::size_t k = 0; k < tile.deltaLights.size(); ++k)
    {
        const SampledLight sampled = tile.deltaLights[k];
        if (!isSoft((*tile.context.lights)[sampled.light]))
        {
            addDeltaLight(tile, block, sampled.light, sampled.weight, u, v);
            continue;
        }
        const uint32_t count = tile.softGrid.samples();
        for (uint32_t j = 0; j < count; ++j)
        {
            tile.softGrid.draw(number, j, block.seed, u, v);
            addDeltaLight(tile, block, sampled.light, sampled.weight / static_cast<float>(count), u,
                          v);
        }
        ++number;
    }
}

} // namespace

void addDirectLight(WhittedTile& tile, ShadingBlock* blocks, int count)
{
    const LightTable& lights = tile.context.traced->lights();
    addAreaLights(tile, blocks, count);
    for (ShadingBlock* block = blocks; tile.samplesTree && block != blocks + count; ++block)
        addTreeLights(tile, *block);
    if (lights.shiningEnvironment()) addEnvironment(tile, blocks, count);
    if (tile.deltaLights.empty()) return;
    for (ShadingBlock* block = blocks; block != blocks + count; ++block)
        addDeltaLights(tile, *block);
}

} // namespace osgRayTrace::engine
