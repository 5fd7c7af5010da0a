// Measurement.cpp - one session a seed, a row a budget. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Measurement.h"

#include "apps/osgraytracebench/report/BudgetSums.h"
#include "osgRayTrace/film/ToneMap.h"

#include <algorithm>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kManySeeds = 8, kSomeSeeds = 4, kFewSeeds = 2;
constexpr int kQuickSeeds = 16, kQuickKernelSeeds = 8; ///< a pass of photons takes longer
constexpr int kFlipSeeds = 4;

engine::StopRule ruleFor(const BudgetPlan& plan, double budget, double secondsSoFar)
{
    engine::StopRule rule;
    if (plan.timed)
        rule.seconds = budget - secondsSoFar;
    else
        rule.passes = static_cast<int>(budget);
    return rule;
}

/// Takes one picture through all the budgets that this seed has to reach.
void renderSeed(const PreparedScene& prepared, const Method& method, int seed,
                const BudgetPlan& plan, std::vector<BudgetSums>& sums, MeasuredLine& measured)
{
    const auto session = newSession(prepared, method, static_cast<uint32_t>(seed + 1));
    engine::RenderProgress progress;
    for (std::size_t b = 0; b < plan.budgets.size() && seed < plan.seeds[b]; ++b)
    {
        if (!plan.timed || progress.seconds < plan.budgets[b])
            progress = renderOn(*session, ruleFor(plan, plan.budgets[b], progress.seconds));
        const Pixels pixels = pixelsOf(*session);
        const bool wantsFlip = seed < kFlipSeeds;
        sums[b].add(pixels, {progress.seconds, static_cast<double>(progress.passes),
                             static_cast<double>(progress.rays.total()),
                             static_cast<int64_t>(progress.droppedSamples), wantsFlip});
        if (seed > 0 || b != plan.budgets.size() / 2) continue;
        measured.picture = pixels;
        measured.pictureBudget = plan.budgets[b];
    }
}

std::vector<Series> seriesOf(const std::vector<BudgetSums>& sums, bool timed)
{
    std::vector<Series> series(sums.front().seeds());
    for (const BudgetSums& budget : sums)
    {
        for (std::size_t seed = 0; seed < budget.seeds(); ++seed)
        {
            series[seed].x.push_back(timed ? budget.seconds(seed) : budget.passes(seed));
            series[seed].y.push_back(budget.relMse(seed));
        }
    }
    return series;
}

} // namespace

BudgetPlan timedPlan(double longest)
{
    BudgetPlan plan;
    for (double seconds = 0.125; seconds <= 1.001 * longest; seconds *= 2.0)
    {
        plan.budgets.push_back(seconds);
        plan.seeds.push_back(seconds <= 1.0 ? kManySeeds : seconds <= 4.0 ? kSomeSeeds : kFewSeeds);
    }
    return plan;
}

BudgetPlan quickPlan(const Method& method, int seeds)
{
    BudgetPlan plan;
    plan.timed = false;
    if (seeds <= 0) seeds = hasKernel(method) ? kQuickKernelSeeds : kQuickSeeds;
    for (double passes = 2.0; passes <= 64.0; passes *= 2.0)
    {
        plan.budgets.push_back(passes);
        plan.seeds.push_back(seeds);
    }
    return plan;
}

MeasuredLine measure(const ReportScene& scene, const Placement& placement, const Method& method,
                     const PreparedScene& prepared, const Reference& reference,
                     const BudgetPlan& plan)
{
    MeasuredLine measured;
    ReportLine& line = measured.line;
    line.scene = scene.name;
    line.placement = placement.name;
    line.method = method.name;
    line.reference = reference.origin;
    line.kernel = hasKernel(method);
    line.buildSeconds = prepared.buildSeconds;

    engine::StopRule onePass;
    onePass.passes = 1;
    renderOn(*newSession(prepared, method, 0), onePass); // warms caches up
    std::vector<BudgetSums> sums(plan.budgets.size(), BudgetSums(reference));
    for (int seed = 0; seed < plan.seeds.front(); ++seed)
        renderSeed(prepared, method, seed, plan, sums, measured);

    const bool whitted = method.options.integrator == engine::IntegratorKind::Whitted;
    const int lightSamples = whitted ? engine::lightSampleCount(method.options) : 1;
    std::vector<double> seconds, errors;
    for (std::size_t b = 0; b < sums.size(); ++b)
    {
        ReportRow row = sums[b].row();
        row.budget = plan.budgets[b];
        row.samples = row.passes * lightSamples;
        seconds.push_back(row.seconds);
        errors.push_back(row.relMse);
        line.rows.push_back(row);
    }
    if (const std::optional<Slope> slope = logLogSlope(seriesOf(sums, plan.timed)))
    {
        line.slope = slope->value;
        line.slopeError = slope->error;
    }
    for (std::size_t t = 0; t < kTargets.size(); ++t)
        line.secondsTo[t] = crossing(seconds, errors, kTargets[t]);
    return measured;
}

} // namespace osgRayTrace::bench
