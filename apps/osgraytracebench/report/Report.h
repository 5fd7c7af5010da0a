// Report.h - the result of a report: lines of rows. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Holds the means of several pictures with independent seeds that had one budget.
struct ReportRow
{
    double budget = 0.0;  ///< [s] or passes
    int seeds = 0;        ///< pictures
    double seconds = 0.0; ///< time of rendering; the BVH is not in it
    double passes = 0.0;
    double samples = 0.0; ///< samples a pixel: passes times light samples (Whitted)
    double rays = 0.0;
    double relMse =
        0.0; ///< mean((x - r)^2 / (r^2 + e^2)), e = 1 % of the reference's mean luminance
    double relMseError = 0.0; ///< standard error, from the scatter of the seeds
    double relMseFixed = 0.0; ///< relMSE with r^2 + 0.01, as by osgraytrace --reference
    double mse = 0.0;
    double mseError = 0.0;
    double biasPercent = 0.0;   ///< bias of the mean radiance, signed
    double biasError = 0.0;     ///< standard error of biasPercent, rounding of floats included
    double percentile999 = 0.0; ///< 99.9th percentile of |x - r|
    double flip = 0.0;       ///< mean FLIP of display values at an exposure fitted to the reference
    int64_t nonFinite = 0;   ///< samples dropped and values in pictures, of all seeds
    double variance = 0.0;   ///< variance of one picture's pixels and colours, unbiased, over the
                             ///< seeds; mse less this is the square of the bias
    double efficiency = 0.0; ///< 1 / (variance * seconds)
};

constexpr std::array<double, 4> kTargets{1e-1, 1e-2, 1e-3, 1e-4}; ///< goals of relMSE

/// Holds the rows of one method on one scene.
struct ReportLine
{
    std::string scene, placement, method;
    std::string reference;     ///< origin of the reference
    bool kernel = false;       ///< true: biased by the width of its kernel: see hasKernel
    double buildSeconds = 0.0; ///< time of conversion and BVH [s]
    std::vector<ReportRow> rows;
    double slope = 0.0;      ///< slope of log relMSE over log seconds, or over log passes
    double slopeError = 0.0; ///< standard error
    std::array<std::optional<double>, 4>
        secondsTo; ///< seconds to kTargets; nothing: not reached, or met before the first row
};

/// Holds the mean squared error of E/L against the number of light samples N, one pass, single
/// receivers.
struct SamplerPoint
{
    int samples = 0;
    double mse = 0.0;
    double mseError = 0.0;
};

struct SamplerLine
{
    std::string scene, strategy;
    std::vector<SamplerPoint> points;
    double slope = 0.0, slopeError = 0.0;
    double secondsPerSample = 0.0; ///< wall clock time of all points over all their samples [s]
};

/// Holds the bias and scatter that are left after so many passes, means over the pixels of a
/// picture.
struct SchedulePoint
{
    int passes = 0;
    double biasSquare = 0.0;      ///< mse less variance; noise may make it negative
    double variance = 0.0;        ///< variance of one picture
    double error = 0.0;           ///< standard error of biasSquare + variance
    double exactBiasSquare = 0.0; ///< formula for the global schedule
    double exactVariance = 0.0;   ///< formula for the global schedule and independent photons
};

/// Holds one way of shrinking the radius of photon lookups.
struct ScheduleLine
{
    std::string schedule;
    std::vector<SchedulePoint> points;
};

struct Report
{
    std::map<std::string, std::string> machine; ///< cpu, threads, isa, versions
    bool timed = true;                          ///< true: budgets are seconds; false: passes
    int width = 0;
    std::vector<ReportLine> lines;
    std::vector<SamplerLine> samplers;
    std::vector<ScheduleLine> schedules;
};

} // namespace osgRayTrace::bench
