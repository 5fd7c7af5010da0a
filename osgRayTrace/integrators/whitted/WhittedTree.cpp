// WhittedTree.cpp - light from some of many lights, chosen by a tree. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// With n samples, u uniform in [0,1) and the emitter c_j that the tree chooses for u + j/n (modulo
// 1), the light of all emitters is estimated by
//
//   L = sum over j of f cos L(c_j) V / (n pmf(c_j) pdfW)
//
// The choices are spread evenly over the leaves of the tree, whose neighbours are neighbours in
// space [systematic sampling: Cochran77, ch. 8].
#include "osgRayTrace/integrators/shared/TreeLights.h"
#include "osgRayTrace/integrators/whitted/WhittedTile.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// The dimensions of the tree lie apart from those of lights that are sampled one by one.
constexpr uint32_t kTreeDimension = 0x20000u;

OSGRAYTRACE_KERNEL
void firstChoices(const UintLanes& seeds, uint32_t passIndex, FloatLanes& choice)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float x, y;
        sobol2(passIndex, dimensionSeed(seeds[i], kTreeDimension), x, y);
        choice[i] = x;
    }
}

/// Returns a choice moved by a share of the unit interval, within it.
float movedBy(float choice, float share)
{
    const float sum = choice + share;
    return std::min(sum < 1.0f ? sum : sum - 1.0f, kOneMinusEpsilon);
}

/// Adds one sample of the tree.
void addTreeSample(WhittedTile& tile, ShadingBlock& block, LaneMask lanes, TreeSamples& samples)
{
    const PassContext& context = tile.context;
    const LaneMaterials& m = block.materials;
    LightLanes& lights = samples.lights;
    // OpenGL's equations light fixed-function lanes from point lights, and Bsdfs from areas.
    const LaneMask classic = samples.points & m.fixedFunction;
    const LaneMask reached = lights.lit & classic;
    for (const int i : lanesIn(reached))
        if (glm::dot(m.points[i].normal, laneOf(lights.wi, i)) <= 0.0f) lights.lit &= ~(1u << i);
    const LaneMask visible = visibleLanes(context, samples, tile.result.counts);
    if (context.traced->traits().media) dimSamples(tile, visible, lights);
    countRays(tile, block, lights.lit);
    for (const int i : lanesIn(reached))
    {
        const LightEmitter emitter = context.traced->lights().tree()->emitter(samples.emitters[i]);
        const float weight = (visible >> i) & 1u ? lights.weight[i] * samples.pmf[i] : 0.0f;
        addFixedFunctionLight(block, lights, (*context.lights)[emitter.light], i,
                              1.0f / samples.pmf[i], weight);
    }
    addSampledLight(block, lights, visible & lanes & ~classic, 1.0f);
}

} // namespace

void addTreeLights(WhittedTile& tile, ShadingBlock& block)
{
    const LaneMaterials& m = block.materials;
    const LaneMask lanes = m.diffuse | m.physical | m.fixedFunction;
    if (!lanes) return;
    const PassContext& context = tile.context;
    const TreePoints points = treePoints(block.surface, m.normal, m.transmissive);
    FloatLanes first, choice, u, v;
    firstChoices(block.seed, context.key.index, first);
    const uint32_t count = tile.treeGrid.samples();
    for (uint32_t j = 0; j < count; ++j)
    {
        const float share = static_cast<float>(j) / static_cast<float>(count);
        for (int i = 0; i < kLanes; ++i)
            choice[i] = movedBy(first[i], share);
        tile.treeGrid.draw(0, j, block.seed, u, v);
        TreeSamples samples;
        treeLightLanes(context, points, choice, static_cast<float>(count),
                       {block.surface, lanes, m.transmissive, u, v}, samples);
        addTreeSample(tile, block, lanes, samples);
    }
}

} // namespace osgRayTrace::engine
