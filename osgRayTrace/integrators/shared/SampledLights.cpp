// SampledLights.cpp - the choice of the lights that a pass samples. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SampledLights.h"

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/shading/LightTable.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kGoldenSection = 0.6180339887498949;

/// Returns the begin of the evenly spaced points of a pass, in units of their distance.
double offsetOf(const PassKey& key)
{
    const double begin = hash(key.seed, 0x11647u) * 0x1p-32 + key.index * kGoldenSection;
    return begin - std::floor(begin);
}

/// Returns the lights that a pass samples: no more than most. choose(u) returns one of the lights,
/// chosen in proportion to power, and its probability.
template <class Choose>
SampledLights sampledLights(const std::vector<uint32_t>& lights, std::size_t most,
                            const PassKey& key, const Choose& choose)
{
    if (lights.size() <= most) return SampledLights(lights);
    std::vector<SampledLight> sampled;
    sampled.reserve(most);
    const double offset = offsetOf(key);
    for (std::size_t j = 0; j < most; ++j)
    {
        const double u = (static_cast<double>(j) + offset) / static_cast<double>(most);
        const LightTable::Choice choice = choose(std::min(static_cast<float>(u), kOneMinusEpsilon));
        const float weight = 1.0f / (choice.pmf * static_cast<float>(most));
        if (!std::isfinite(weight)) continue;
        if (!sampled.empty() && sampled.back().light == choice.light)
            sampled.back().weight += weight;
        else
            sampled.push_back({choice.light, weight});
    }
    return SampledLights(std::move(sampled));
}

} // namespace

int samplesOfEach(const RenderOptions& options, std::size_t lights)
{
    const int wanted = lightSampleCount(options);
    if (lights <= kMostFullySampled) return wanted;
    const int most =
        static_cast<int>(kMostFullySampled * static_cast<std::size_t>(wanted) / lights);
    if (most < 1) return 1;
    const bool cells = options.lightSampling == LightSampling::UniformJitter ||
                       options.lightSampling == LightSampling::Stratified;
    if (!cells) return most;
    int side = 1;
    while ((side + 1) * (side + 1) <= most)
        ++side;
    return side * side;
}

bool samplesTree(const PassContext& context)
{
    const LightTable& table = context.traced->lights();
    if (!table.tree()) return false;
    return context.options.integrator != IntegratorKind::Whitted ||
           table.areaLights().size() + table.deltaLights().size() > kMostLoopedLights;
}

SampledLights sampledAreaLights(const PassContext& context)
{
    if (samplesTree(context)) return SampledLights(std::vector<SampledLight>());
    return SampledLights(context.traced->lights().areaLights());
}

SampledLights sampledDeltaLights(const PassContext& context)
{
    const LightTable& table = context.traced->lights();
    return sampledLights(samplesTree(context) ? table.lightsBesideTree() : table.deltaLights(),
                         kMostDeltaLights, context.key,
                         [&table](float u) { return table.chooseDeltaLight(u); });
}

SampledLightCounts sampledLightCounts(const PassContext& context)
{
    const LightTable& table = context.traced->lights();
    SampledLightCounts counts;
    if (context.options.integrator == IntegratorKind::Debug) return counts;
    const bool tree = samplesTree(context);
    counts.deltaLights = tree ? table.lightsBesideTree().size() : table.deltaLights().size();
    counts.sampledDeltaLights = std::min(counts.deltaLights, kMostDeltaLights);
    // Integrators other than Whitted have a new choice of lights at each point of each path.
    if (!tree || context.options.integrator != IntegratorKind::Whitted) return counts;
    counts.treeLights = table.areaLights().size() + table.deltaLights().size() - counts.deltaLights;
    counts.treeSamples = kTreePicks * lightSampleCount(context.options);
    return counts;
}

} // namespace osgRayTrace::engine
