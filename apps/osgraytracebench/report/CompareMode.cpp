// CompareMode.cpp - tests of rows against their standard errors. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/CompareMode.h"

#include "apps/common/Failure.h"
#include "apps/osgraytracebench/report/ReportFiles.h"
#include "apps/osgraytracebench/report/Slopes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kSamplerGroups = 16; ///< groups that give the samplers' standard errors
constexpr int kCannotCompare = 2;

/// Holds a measured value by which rows are compared.
struct Quantity
{
    std::string name;
    double value = 0.0, error = 0.0;
    double degrees = 0.0; ///< degrees of freedom of the error; 0: many
    bool logarithmic = false;
};

struct Measured
{
    std::vector<Quantity> quantities;
    int64_t nonFinite = 0;
    double raysPerSecond = 0.0;
};

std::map<std::string, Measured> measuredRows(const Report& report)
{
    std::map<std::string, Measured> rows;
    for (const ReportLine& line : report.lines)
    {
        for (const ReportRow& row : line.rows)
        {
            char budget[32];
            std::snprintf(budget, sizeof budget, "%g %s", row.budget,
                          report.timed ? "s" : "passes");
            Measured& measured =
                rows[line.scene + ", " + line.placement + ", " + line.method + ", " + budget];
            measured.quantities = {{"relMSE", row.relMse, row.relMseError, row.seeds - 1.0, true},
                                   {"bias [%]", row.biasPercent, row.biasError, 0.0, false}};
            measured.nonFinite = row.nonFinite;
            if (row.seconds > 0.0) measured.raysPerSecond = row.rays / row.seconds;
        }
    }
    for (const SamplerLine& line : report.samplers)
    {
        for (const SamplerPoint& point : line.points)
            rows["samplers, " + line.scene + ", " + line.strategy +
                 ", N = " + std::to_string(point.samples)]
                .quantities = {{"MSE", point.mse, point.mseError, kSamplerGroups - 1.0, true}};
    }
    return rows;
}

/// Returns the probability of a difference like that of a and b if they were equal; 2 if the
/// probability is unknown.
double probabilityOf(const Quantity& a, const Quantity& b)
{
    if (a.value == b.value) return 1.0;
    double difference = a.value - b.value, errorA = a.error, errorB = b.error;
    if (a.logarithmic && a.value > 0.0 && b.value > 0.0)
    {
        difference = std::log(a.value / b.value);
        errorA /= a.value;
        errorB /= b.value;
    }
    const double squareA = errorA * errorA, squareB = errorB * errorB, variance = squareA + squareB;
    if (!std::isfinite(variance)) return 2.0;
    if (variance == 0.0) return 0.0;
    const double t = std::abs(difference) / std::sqrt(variance);
    if (a.degrees <= 0.0 || b.degrees <= 0.0) return std::erfc(t / std::sqrt(2.0));
    // The degrees of freedom are those of Welch and Satterthwaite [Welch47].
    const double degrees =
        variance * variance / (squareA * squareA / a.degrees + squareB * squareB / b.degrees);
    return studentTail(t, degrees);
}

struct Pair
{
    const std::string* row;
    const Quantity *before, *after;
    double probability;
};

} // namespace

Comparison compareReports(const Report& before, const Report& after, double falseAlarmRate)
{
    const std::map<std::string, Measured> first = measuredRows(before),
                                          second = measuredRows(after);
    Comparison result;
    std::vector<Pair> pairs;
    std::vector<double> speeds;
    std::size_t matched = 0;
    for (const auto& [row, a] : first)
    {
        const auto found = second.find(row);
        if (found == second.end()) continue;
        ++matched;
        const Measured& b = found->second;
        for (std::size_t q = 0; q < a.quantities.size(); ++q)
        {
            const double probability = probabilityOf(a.quantities[q], b.quantities[q]);
            if (probability > 1.0)
                ++result.untested;
            else
                pairs.push_back({&row, &a.quantities[q], &b.quantities[q], probability});
        }
        if (a.nonFinite != b.nonFinite)
            result.changes.push_back(
                {row, "non-finite samples", double(a.nonFinite), double(b.nonFinite), 0.0});
        if (a.raysPerSecond > 0.0 && b.raysPerSecond > 0.0)
            speeds.push_back(b.raysPerSecond / a.raysPerSecond);
    }
    result.onlyInOne = first.size() + second.size() - 2 * matched;
    result.tests = pairs.size();
    result.significance = sidak(falseAlarmRate, pairs.size());
    for (const Pair& pair : pairs)
    {
        if (pair.probability < result.significance)
            result.changes.push_back({*pair.row, pair.before->name, pair.before->value,
                                      pair.after->value, pair.probability});
    }
    std::sort(speeds.begin(), speeds.end());
    if (!speeds.empty()) result.raysPerSecond = speeds[speeds.size() / 2];
    return result;
}

int runCompare(const std::string& before, const std::string& after, double falseAlarmRate)
{
    Report first, second;
    try
    {
        first = readJson(before);
        second = readJson(after);
    }
    catch (const app::Failure& failure)
    {
        std::fprintf(stderr, "osgraytracebench: %s\n", failure.what());
        return kCannotCompare;
    }
    const Comparison comparison = compareReports(first, second, falseAlarmRate);
    if (comparison.tests == 0)
    {
        std::fprintf(stderr, "osgraytracebench: the reports have no rows in common\n");
        return kCannotCompare;
    }

    for (const Change& change : comparison.changes)
        std::printf("changed: %s: %s %.4g -> %.4g, p = %.2g\n", change.row.c_str(),
                    change.quantity.c_str(), change.before, change.after, change.probability);
    std::printf("%zu of %zu tests say changed. By chance alone one or more would in %g %% of "
                "comparisons: each "
                "test has a significance of %.2g.\n",
                comparison.changes.size(), comparison.tests, 100.0 * falseAlarmRate,
                comparison.significance);
    if (comparison.untested > 0)
        std::printf("%zu values of single pictures could not be tested.\n", comparison.untested);
    if (comparison.onlyInOne > 0)
        std::printf("%zu rows are in one report only.\n", comparison.onlyInOne);
    if (comparison.raysPerSecond > 0.0)
        std::printf("Rays a second, after by before, median over rows: %.3f (not tested).\n",
                    comparison.raysPerSecond);
    return comparison.changes.empty() ? 0 : 1;
}

} // namespace osgRayTrace::bench
