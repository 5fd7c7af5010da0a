// Expectations.cpp - the checks of a quick report. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Expectations.h"

#include "apps/common/Failure.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace osgRayTrace::bench
{

using nlohmann::json;

namespace
{

__attribute__((format(printf, 1, 2))) std::string text(const char* format, ...)
{
    char buffer[400];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    return buffer;
}

std::string nameOf(const ReportLine& line)
{
    return line.scene + ", " + line.placement + ", " + line.method;
}

const ReportLine* findLine(const Report& report, const std::string& scene,
                           const std::string& placement, const std::string& method)
{
    for (const ReportLine& line : report.lines)
    {
        if (line.scene == scene && line.placement == placement && line.method == method)
            return &line;
    }
    return nullptr;
}

const SamplerLine* findSampler(const Report& report, const std::string& scene,
                               const std::string& strategy)
{
    for (const SamplerLine& line : report.samplers)
    {
        if (line.scene == scene && line.strategy == strategy) return &line;
    }
    return nullptr;
}

Verdict notMeasured(const std::string& what)
{
    return {what + ": not measured", false};
}

/// Checks scenes with a formula, at their largest budget.
void checkBias(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    const double mostPercent = wanted.at("largest_percent"),
                 mostErrors = wanted.at("largest_errors");
    bool any = false;
    for (const ReportLine& line : report.lines)
    {
        if (line.reference != "formula" || line.kernel) continue;
        any = true;
        const ReportRow& row = line.rows.back();
        const double errors = row.biasPercent / row.biasError;
        const bool met = std::abs(row.biasPercent) < mostPercent && std::abs(errors) <= mostErrors;
        verdicts.push_back({text("bias of %s: %+.2g %%, %+.2f standard errors",
                                 nameOf(line).c_str(), row.biasPercent, errors),
                            met});
    }
    if (!any) verdicts.push_back(notMeasured("bias of any scene with a formula"));
}

/// Returns the square of the bias of the pixels: the variance is taken off.
double biasSquare(const ReportRow& row)
{
    return row.mse - row.variance;
}

/// Checks methods with a kernel, which are biased, less from pass to pass. Their mean may be off by
/// so much and no more; the square of the pixels' bias by so much or by a share of that of the
/// first row; and the error must fall along a slope.
void checkKernels(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    std::vector<const ReportLine*> checked;
    for (const json& entry : wanted)
    {
        const std::string scene = entry.at("scene"), method = entry.at("method");
        const ReportLine* line = findLine(report, scene, "origin", method);
        if (!line)
        {
            verdicts.push_back(notMeasured("bias of " + method + " on " + scene));
            continue;
        }
        checked.push_back(line);
        const ReportRow &first = line->rows.front(), &last = line->rows.back();
        const double mostPercent = entry.at("largest_percent");
        verdicts.push_back({text("mean of %s: %+.2g %%, wanted within %g", nameOf(*line).c_str(),
                                 last.biasPercent, mostPercent),
                            std::abs(last.biasPercent) <= mostPercent});
        if (entry.contains("bias_square_left"))
        {
            const double left = biasSquare(last) / biasSquare(first),
                         most = entry.at("bias_square_left");
            verdicts.push_back(
                {text("squared bias of %s: %.3g, %.3g of that of %g passes, wanted "
                      "at most %g",
                      nameOf(*line).c_str(), biasSquare(last), left, first.budget, most),
                 biasSquare(first) > 0.0 && left <= most});
        }
        if (entry.contains("bias_square"))
        {
            const double most = entry.at("bias_square");
            verdicts.push_back({text("squared bias of %s: %.3g, wanted at most %g",
                                     nameOf(*line).c_str(), biasSquare(last), most),
                                biasSquare(last) <= most});
        }
        if (entry.contains("slope"))
        {
            const double least = entry.at("slope").at(0), most = entry.at("slope").at(1);
            verdicts.push_back(
                {text("slope of %s: %.3f +- %.3f, wanted from %g to %g", nameOf(*line).c_str(),
                      line->slope, line->slopeError, least, most),
                 line->slope >= least && line->slope <= most});
        }
    }
    for (const ReportLine& line : report.lines)
    {
        const bool formula = line.reference == "formula" && line.placement == "origin";
        if (!line.kernel || !formula) continue;
        if (std::find(checked.begin(), checked.end(), &line) == checked.end())
            verdicts.push_back({nameOf(line) + ": nothing is expected of it", false});
    }
}

void checkNonFinite(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    int64_t sum = 0;
    for (const ReportLine& line : report.lines)
        for (const ReportRow& row : line.rows)
            sum += row.nonFinite;
    verdicts.push_back({text("samples that are not finite: %lld", static_cast<long long>(sum)),
                        sum <= wanted.get<int64_t>()});
}

/// Checks that a scene elsewhere in the world has the mean and the error of the origin.
void checkPlacements(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    const double mostErrors = wanted.at("largest_errors");
    for (const ReportLine& line : report.lines)
    {
        if (line.placement == "origin") continue;
        const ReportLine* origin = findLine(report, line.scene, "origin", line.method);
        if (!origin || origin->rows.size() != line.rows.size())
        {
            verdicts.push_back(notMeasured(line.scene + " at the origin"));
            continue;
        }
        const ReportRow &here = line.rows.back(), &there = origin->rows.back();
        const double bias =
            (here.biasPercent - there.biasPercent) / std::hypot(here.biasError, there.biasError);
        const double error =
            (here.relMse - there.relMse) / std::hypot(here.relMseError, there.relMseError);
        verdicts.push_back({text("%s against the origin: mean %+.2f, relMSE %+.2f standard errors",
                                 nameOf(line).c_str(), bias, error),
                            std::abs(bias) <= mostErrors && std::abs(error) <= mostErrors});
    }
}

void checkSlopes(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    for (const json& entry : wanted)
    {
        const std::string scene = entry.at("scene"), strategy = entry.at("strategy");
        const SamplerLine* line = findSampler(report, scene, strategy);
        if (!line)
        {
            verdicts.push_back(notMeasured("slope of " + strategy + " below " + scene));
            continue;
        }
        const double most = entry.at("at_most"), least = entry.value("at_least", -100.0);
        verdicts.push_back(
            {text("slope of %s, %s: %.3f +- %.3f, wanted at most %g%s", scene.c_str(),
                  strategy.c_str(), line->slope, line->slopeError, most,
                  least > -100.0 ? text(" and at least %g", least).c_str() : ""),
             line->slope <= most && line->slope >= least});
    }
}

/// Checks that the squared bias is that of the formula, and that the variance is no more than that
/// of independent photons.
void checkSchedules(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    for (const json& entry : wanted)
    {
        const std::string schedule = entry.at("schedule");
        const auto line =
            std::find_if(report.schedules.begin(), report.schedules.end(),
                         [&](const ScheduleLine& l) { return l.schedule == schedule; });
        if (line == report.schedules.end() || line->points.empty())
        {
            verdicts.push_back(notMeasured("schedule " + schedule));
            continue;
        }
        const SchedulePoint& last = line->points.back();
        const double bias = last.biasSquare / last.exactBiasSquare,
                     variance = last.variance / last.exactVariance;
        const double least = entry.at("bias_square").at(0), most = entry.at("bias_square").at(1),
                     mostVariance = entry.at("variance_at_most");
        verdicts.push_back(
            {text("%s, %d passes: squared bias %.3f of the formula's, wanted from %g "
                  "to %g",
                  schedule.c_str(), last.passes, bias, least, most),
             bias >= least && bias <= most});
        verdicts.push_back({text("%s, %d passes: variance %.3f of the formula's, wanted at most %g",
                                 schedule.c_str(), last.passes, variance, mostVariance),
                            variance > 0.0 && variance <= mostVariance});
    }
}

double mseAt(const SamplerLine* line, int samples)
{
    if (!line) return std::nan("");
    for (const SamplerPoint& point : line->points)
    {
        if (point.samples == samples) return point.mse;
    }
    return std::nan("");
}

/// Checks errors at one number of samples; comparisons with something that was not measured fail.
void checkOrders(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    for (const json& entry : wanted)
    {
        const std::string scene = entry.at("scene");
        const int samples = entry.at("samples");
        const std::vector<std::string> order = entry.at("best_first");
        for (std::size_t i = 1; i < order.size(); ++i)
        {
            const double better = mseAt(findSampler(report, scene, order[i - 1]), samples);
            const double worse = mseAt(findSampler(report, scene, order[i]), samples);
            verdicts.push_back({text("%s, N = %d: %s %.3g, %s %.3g", scene.c_str(), samples,
                                     order[i - 1].c_str(), better, order[i].c_str(), worse),
                                better < worse});
        }
    }
}

/// Checks relMSE of one method over another's on one scene at the largest budget.
void checkRatios(const Report& report, const json& wanted, std::vector<Verdict>& verdicts)
{
    for (const json& entry : wanted)
    {
        const std::string scene = entry.at("scene"), method = entry.at("method"),
                          over = entry.at("over");
        const ReportLine* line = findLine(report, scene, "origin", method);
        const ReportLine* other = findLine(report, scene, "origin", over);
        if (!line || !other)
        {
            verdicts.push_back(notMeasured(scene + ": " + method + " over " + over));
            continue;
        }
        const double ratio = line->rows.back().relMse / other->rows.back().relMse;
        const double most = entry.at("at_most");
        verdicts.push_back({text("%s: relMSE of %s over %s: %.3g, wanted at most %g", scene.c_str(),
                                 method.c_str(), over.c_str(), ratio, most),
                            ratio <= most});
    }
}

} // namespace

std::vector<Verdict> checkExpectations(const Report& report, const std::string& expectations)
{
    try
    {
        const json wanted = json::parse(expectations);
        std::vector<Verdict> verdicts;
        checkNonFinite(report, wanted.at("non_finite"), verdicts);
        checkBias(report, wanted.at("bias"), verdicts);
        checkKernels(report, wanted.at("kernels"), verdicts);
        checkPlacements(report, wanted.at("placements"), verdicts);
        checkSlopes(report, wanted.at("sampler_slopes"), verdicts);
        checkSchedules(report, wanted.at("schedules"), verdicts);
        checkOrders(report, wanted.at("sampler_orders"), verdicts);
        checkRatios(report, wanted.at("method_ratios"), verdicts);
        return verdicts;
    }
    catch (const json::exception& error)
    {
        throw app::Failure(app::kCannotLoad,
                           std::string("the expectations cannot be read: ") + error.what());
    }
}

} // namespace osgRayTrace::bench
