// ScheduleStudy.cpp - the flat mirror's floor with a known first radius. Layer: apps.
// SPDX-License-Identifier: MIT
//
// The irradiance E that comes by the mirror is known, and so is its Laplacian. A disc of radius r
// sees E + r^2 lap(E) / 8 in the mean; for independent photons of power w each, its variance is E w
// / (pi r^2). The average of N passes has the mean of the biases, and 1/N of the mean of the
// variances. With r_i^2 = r_1^2 prod (k + alpha) / (k + 1), k = 1 to i - 1 [Knaus11], these are:
//
//   mean of r_i^2 / r_1^2 = (1 / (N alpha)) (Gamma(N + 1 + alpha) / (Gamma(1 + alpha) N!) - 1)
//   mean of r_1^2 / r_i^2 / N = Gamma(1 + alpha) / ((2 - alpha) N^2) ((N + 1)! / Gamma(N + alpha) -
//                               1 / Gamma(alpha))
#include "apps/osgraytracebench/report/ScheduleStudy.h"

#include "apps/osgraytracebench/report/CausticScenes.h"
#include "apps/osgraytracebench/report/Measurement.h"

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kWidth = 64;
constexpr double kRadius = 0.25; ///< radius of the first pass: the bias shows, its next term hardly
constexpr int kPhotons = 1 << 17; ///< photons of a pass: the scatter does not hide the bias
constexpr double kAlbedo = 0.5;

/// Holds means over the picture of the squared bias and of the variance of one pass with the radius
/// r_1.
struct FirstPass
{
    double biasSquare = 0.0, variance = 0.0;
};

/// Returns the figures of the first pass. A lamp of diffuse 1 has the intensity pi: power 4 pi^2,
/// and E = pi e.
FirstPass firstPass(const ReportScene& scene)
{
    constexpr double kStep = 1e-3;
    const osg::Matrixd sceneFromClip = osg::Matrixd::inverse(scene.view * scene.projection);
    FirstPass sums;
    for (int i = 0; i < kWidth * kWidth; ++i)
    {
        const double u = (2.0 * (i % kWidth) + 1.0) / kWidth - 1.0;
        const double v = (2.0 * (i / kWidth) + 1.0) / kWidth - 1.0;
        const osg::Vec3d near = osg::Vec3d(u, v, -1.0) * sceneFromClip;
        const osg::Vec3d ray = osg::Vec3d(u, v, 1.0) * sceneFromClip - near;
        const osg::Vec3d point = near - ray * (near.z() / ray.z());
        const double x = -point.x(), y = point.y(), e = flatMirrorIrradiance(x, y);
        const double laplacian =
            (flatMirrorIrradiance(x + kStep, y) + flatMirrorIrradiance(x - kStep, y) +
             flatMirrorIrradiance(x, y + kStep) + flatMirrorIrradiance(x, y - kStep) - 4.0 * e) /
            (kStep * kStep);
        const double bias = kAlbedo * kRadius * kRadius * laplacian / 8.0;
        sums.biasSquare += bias * bias;
        sums.variance += kAlbedo * kAlbedo * 4.0 * e / (kPhotons * kRadius * kRadius);
    }
    return {sums.biasSquare / (kWidth * kWidth), sums.variance / (kWidth * kWidth)};
}

ScheduleLine lineOf(const ReportScene& scene, const PreparedScene& prepared,
                    const Reference& reference, const FirstPass& first, const Method& method,
                    const BudgetPlan& plan)
{
    const MeasuredLine measured = measure(scene, atOrigin(), method, prepared, reference, plan);
    ScheduleLine line;
    line.schedule = method.name;
    for (const ReportRow& row : measured.line.rows)
    {
        const int passes = static_cast<int>(row.passes);
        const auto alpha = static_cast<double>(method.options.photonAlpha);
        SchedulePoint point;
        point.passes = passes;
        point.biasSquare = row.mse - row.variance;
        point.variance = row.variance;
        point.error = row.mseError;
        point.exactBiasSquare = first.biasSquare * std::pow(meanSquaredRadius(passes, alpha), 2.0);
        point.exactVariance = first.variance * meanInverseSquaredRadius(passes, alpha);
        line.points.push_back(point);
    }
    return line;
}

} // namespace

double meanSquaredRadius(int passes, double alpha)
{
    const double n = passes;
    return std::expm1(std::lgamma(n + 1.0 + alpha) - std::lgamma(1.0 + alpha) -
                      std::lgamma(n + 1.0)) /
           (n * alpha);
}

double meanInverseSquaredRadius(int passes, double alpha)
{
    const double n = passes;
    const double sum =
        std::exp(std::lgamma(n + 2.0) - std::lgamma(n + alpha)) - std::exp(-std::lgamma(alpha));
    return std::exp(std::lgamma(1.0 + alpha)) / ((2.0 - alpha) * n * n) * sum;
}

std::vector<ScheduleLine> studySchedules(int seeds, int mostPasses, bool allAlphas,
                                         const std::shared_ptr<engine::Workers>& workers)
{
    const ReportScene scene = flatMirrorScene();
    const PreparedScene prepared = prepare(scene, atOrigin(), kWidth, workers);
    const Reference reference = formulaReference(scene, kWidth, *workers);
    const FirstPass first = firstPass(scene);
    BudgetPlan plan;
    plan.timed = false;
    for (int passes = 1; passes <= mostPasses; passes *= 2)
    {
        plan.budgets.push_back(passes);
        plan.seeds.push_back(seeds);
    }
    struct Schedule
    {
        const char* name;
        engine::RadiusSchedule schedule;
        float alpha;
    };
    std::vector<ScheduleLine> lines;
    std::vector<Schedule> schedules{
        {"GLOBAL, alpha 2/3", engine::RadiusSchedule::Global, 2.0f / 3.0f},
        {"LOCAL, alpha 2/3", engine::RadiusSchedule::Local, 2.0f / 3.0f}};
    if (allAlphas)
    {
        schedules.push_back({"GLOBAL, alpha 1/2", engine::RadiusSchedule::Global, 0.5f});
        schedules.push_back({"GLOBAL, alpha 0.8", engine::RadiusSchedule::Global, 0.8f});
    }
    for (const Schedule& s : schedules)
    {
        Method method = photonMethods(8, false).back();
        method.name = s.name;
        method.options.radiusSchedule = s.schedule;
        method.options.photonAlpha = s.alpha;
        method.options.photonRadius = static_cast<float>(kRadius);
        method.options.photons = kPhotons;
        lines.push_back(lineOf(scene, prepared, reference, first, method, plan));
    }
    return lines;
}

} // namespace osgRayTrace::bench
