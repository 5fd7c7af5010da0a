// TransportMode.cpp - renders the scenes that are hard and prints N = relMSE x seconds. Layer:
// apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/TransportMode.h"

#include "apps/osgraytracebench/report/Measurement.h"
#include "apps/osgraytracebench/report/PreparedScene.h"
#include "apps/osgraytracebench/report/Reference.h"
#include "apps/osgraytracebench/report/TransportScenes.h"
#include "osgRayTrace/base/Parallel.h"

namespace osgRayTrace::bench
{

namespace
{

void measureScene(const ReportScene& scene, const TransportOptions& options, Rows& rows)
{
    const auto workers = std::make_shared<engine::Workers>();
    const PreparedScene prepared = prepare(scene, atOrigin(), options.width, workers);
    const bool known = scene.formula || scene.pictureFormula;
    const Reference reference = known ? formulaReference(scene, options.width, *workers)
                                      : newReference(scene, prepared, options.referenceSeconds);
    const double noise = noiseOf(reference, 0.01 * reference.meanLuminance);
    if (!known) rows.push_back({scene.name + ": noise of the reference", noise, "relMSE"});
    BudgetPlan plan;
    plan.budgets = {options.seconds};
    plan.seeds = {options.seeds};
    // Seconds of two threads for 512 x 512 pixels.
    const double pixels = 512.0 * 512.0 / (reference.width * reference.height);
    const double threads = workers->threads() / 2.0;
    for (const Method& method : scene.methods)
    {
        const MeasuredLine measured = measure(scene, atOrigin(), method, prepared, reference, plan);
        const ReportRow& row = measured.line.rows.back();
        const std::string name = scene.name + ", " + method.name;
        rows.push_back({name + ": relMSE x s, 512 x 512, two threads",
                        row.relMse * row.seconds * pixels * threads,
                        "s"}); // without the reference's noise
        rows.push_back({name + ": mean over the reference", 1.0 + 0.01 * row.biasPercent, ""});
        rows.push_back({name + ": standard error of the mean", 0.01 * row.biasError, ""});
    }
}

} // namespace

void measureTransport(const TransportOptions& options, Rows& rows)
{
    for (const ReportScene& scene : transportScenes())
        if (scene.name.find(options.only) != std::string::npos) measureScene(scene, options, rows);
}

} // namespace osgRayTrace::bench
