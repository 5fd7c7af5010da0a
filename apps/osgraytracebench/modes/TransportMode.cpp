// TransportMode.cpp - renders the scenes that are hard and prints N = relMSE x seconds. Layer:
// apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/TransportMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/report/BudgetSums.h"
#include "apps/osgraytracebench/report/PictureError.h"
#include "apps/osgraytracebench/report/PreparedScene.h"
#include "apps/osgraytracebench/report/TransportScenes.h"
#include "osgRayTrace/base/Parallel.h"

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kFirstPasses = 4; ///< what is learnt about a scene's photons is learnt in them

struct TimedSession
{
    std::unique_ptr<engine::RenderSession> session;
    int passes = 0;
    double seconds = 0.0; ///< [s of one thread]

    void renderTo(int wanted)
    {
        engine::StopRule rule;
        rule.passes = passes = wanted;
        seconds += threadSecondsOf([&] { renderOn(*session, rule); });
        endIfInterrupted();
    }
};

/// Returns the power of two whose time is the nearest to the budget, by ratio.
int passesFor(const PreparedScene& prepared, const Method& method, double seconds)
{
    TimedSession timed{newSession(prepared, method, 0)};
    timed.renderTo(1); // makes tables of the scene, once for all pictures
    timed.seconds = 0.0;
    for (int passes = kFirstPasses;; passes *= 2)
    {
        timed.renderTo(passes);
        if (timed.seconds * std::sqrt(2.0) > seconds) return passes;
    }
}

/// Renders the reference with all threads and as many passes as fit into the seconds of one.
Reference referenceOf(const ReportScene& scene, const PreparedScene& prepared, double seconds)
{
    ReferencePlan plan;
    plan.passes = passesFor(prepared, scene.reference, seconds / plan.seeds);
    PreparedScene parallel = prepared;
    parallel.workers = std::make_shared<engine::Workers>();
    return newReference(scene, parallel, plan);
}

void measureMethod(const ReportScene& scene, const Method& method, const PreparedScene& prepared,
                   const Reference& reference, const TransportOptions& options, Rows& rows)
{
    const int passes = passesFor(prepared, method, options.seconds);
    std::vector<double> seconds, errors, trimmed;
    BudgetSums sums(reference);
    for (int picture = 0; picture < options.seeds; ++picture)
    {
        TimedSession timed{
            newSession(prepared, method, options.firstSeed + static_cast<uint32_t>(picture))};
        timed.renderTo(passes);
        const Pixels pixels = pixelsOf(*timed.session);
        const PictureError error = pictureError(pixels, reference);
        seconds.push_back(timed.seconds);
        errors.push_back(error.relMse);
        trimmed.push_back(error.trimmed);
        sums.add(pixels, {timed.seconds, static_cast<double>(passes), 0.0, 0, false});
    }
    // Seconds of two threads for 512 x 512 pixels.
    const double scale =
        0.5 * 512.0 * 512.0 / (reference.width * reference.height) * median(seconds);
    const SeedMedian typical = medianOfSeeds(trimmed);
    const ReportRow row = sums.row();
    const std::string name = scene.name + ", " + method.name;
    rows.push_back({name + ": relMSE x s, worst 0.1 % left out", typical.value * scale, "s"});
    rows.push_back({name + ":   runs agree within a factor of", typical.agreement, ""});
    rows.push_back({name + ":   largest of the pictures / smallest", typical.spread, ""});
    rows.push_back({name + ": relMSE x s, all pixels", medianOfSeeds(errors).value * scale, "s"});
    rows.push_back({name + ": passes of a picture", static_cast<double>(passes), ""});
    rows.push_back({name + ": mean over the reference", 1.0 + 0.01 * row.biasPercent, ""});
    rows.push_back({name + ": standard error of the mean", 0.01 * row.biasError, ""});
}

void measureScene(const ReportScene& scene, const TransportOptions& options, Rows& rows)
{
    const auto workers = std::make_shared<engine::Workers>(1);
    const PreparedScene prepared = prepare(scene, atOrigin(), options.width, workers);
    const bool known = scene.formula || scene.pictureFormula;
    const Reference reference = known ? formulaReference(scene, options.width, *workers)
                                      : referenceOf(scene, prepared, options.referenceSeconds);
    const double noise = noiseOf(reference, 0.01 * reference.meanLuminance);
    if (!known) rows.push_back({scene.name + ": noise of the reference", noise, "relMSE"});
    for (const Method& method : scene.methods)
        measureMethod(scene, method, prepared, reference, options, rows);
}

} // namespace

void measureTransport(const TransportOptions& options, Rows& rows)
{
    for (const ReportScene& scene : transportScenes())
        if (scene.name.find(options.only) != std::string::npos) measureScene(scene, options, rows);
}

} // namespace osgRayTrace::bench
