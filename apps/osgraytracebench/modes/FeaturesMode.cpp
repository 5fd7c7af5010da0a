// FeaturesMode.cpp - paired renders of scenes with and without a feature. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/FeaturesMode.h"

#include "apps/osgraytracebench/modes/UnusedContent.h"
#include "apps/osgraytracebench/scenes/FeatureScenes.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/RenderSession.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kSize = 128;
constexpr int kPairs = 61;

/// Returns the CPU time of this thread, which renders alone: on a busy machine the wall clock also
/// counts turns of other programs.
double cpuSeconds()
{
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Renders the first pass again and again.
class OnePass
{
public:
    OnePass(const BenchScene& bench, IntegratorKind integrator,
            const std::shared_ptr<Workers>& workers)
        : _session(workers), _traced(TracedScene::build(bench.scene, workers))
    {
        _options.integrator = integrator;
        _options.maxBounces = 5;
        _options.lightSamples = 1;
        _session.setScene(_traced);
        _session.setView(bench.view);
    }

    double seconds()
    {
        // Two seeds take turns, because a new seed begins a new image.
        _options.seed ^= 1u;
        _session.setOptions(_options);
        StopRule rule;
        rule.passes = 1;
        const double begin = cpuSeconds();
        _session.render(rule);
        return cpuSeconds() - begin;
    }

    const SceneTraits& traits() const { return _traced->traits(); }

private:
    RenderSession _session;
    std::shared_ptr<const TracedScene> _traced;
    RenderOptions _options;
};

/// Holds the median of the ratios of pairs, and its standard error by the quartiles.
struct Ratio
{
    double median = 0.0, error = 0.0;
};

Ratio ratioOf(OnePass& with, OnePass& without)
{
    std::vector<double> ratios;
    for (int i = -2; i < kPairs; ++i)
    {
        // Each scene is the first one in turn. Both seeds count alike: two passes each.
        double sums[2] = {0.0, 0.0};
        for (const int which : {i & 1, ~i & 1, ~i & 1, i & 1})
            sums[which] += (which ? with : without).seconds();
        if (i >= 0) ratios.push_back(sums[1] / sums[0]);
    }
    std::sort(ratios.begin(), ratios.end());
    const std::size_t n = ratios.size();
    // Quartiles of a normal distribution are 1.349 standard deviations apart, and the median's
    // error is sqrt(pi/2) times that of the mean.
    const double deviation = (ratios[3 * n / 4] - ratios[n / 4]) / 1.349;
    return {ratios[n / 2], 1.2533 * deviation / std::sqrt(static_cast<double>(n))};
}

std::string namesOf(const SceneTraits& traits)
{
    const std::pair<const char*, bool> all[] = {{"instances", traits.instances},
                                                {"smoothNormals", traits.smoothNormals},
                                                {"textures", traits.textures},
                                                {"vertexColors", traits.vertexColors},
                                                {"fixedFunction", traits.fixedFunction},
                                                {"physical", traits.physical},
                                                {"specular", traits.specular},
                                                {"transmission", traits.transmission},
                                                {"deltaLights", traits.deltaLights},
                                                {"areaLights", traits.areaLights},
                                                {"blended", traits.blended},
                                                {"environment", traits.environment}};
    std::string names;
    for (const auto& [name, on] : all)
        if (on) names += (names.empty() ? "" : " ") + std::string(name);
    return names;
}

void measurePair(const ScenePair& pair, bool hasGoal, Rows& rows)
{
    const auto one = std::make_shared<Workers>(1);
    for (const IntegratorKind kind : {IntegratorKind::Whitted, IntegratorKind::Path})
    {
        OnePass with(pair.with, kind, one), without(pair.without, kind, one);
        const Ratio ratio = ratioOf(with, without);
        const std::string name =
            (kind == IntegratorKind::Path ? "path: " : "whitted: ") + pair.name;
        rows.push_back({name, ratio.median, "of time", hasGoal ? Goal::AtMost : Goal::None, 1.01});
        rows.push_back({name + ", standard error", ratio.error, "of time"});
        if (kind == IntegratorKind::Path)
            rows.push_back({"  traits: " + namesOf(with.traits()), 1.0, ""});
    }
}

} // namespace

void measureFeatures(const std::string& only, Rows& rows)
{
    const auto isAsked = [&](const std::string& name) { return name.find(only) != name.npos; };
    for (const ScenePair& pair : unusedFeatures(kSize))
        if (isAsked(pair.name)) measurePair(pair, true, rows);
    for (const ScenePair& pair : generalWays(kSize))
        if (isAsked(pair.name)) measurePair(pair, false, rows);
    if (isAsked("captures")) measureUnusedContent(rows);
}

} // namespace osgRayTrace::bench
