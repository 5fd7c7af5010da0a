// ReportFiles.cpp - reads and writes reports. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ReportFiles.h"

#include "apps/common/Failure.h"
#include "apps/common/Output.h"
#include "osgRayTrace/base/TextFile.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>

namespace osgRayTrace::bench
{

using nlohmann::ordered_json;

namespace
{

constexpr const char* kFormat = "osgraytracebench report 2";

/// Describes a column of a row: one table serves both formats.
struct Column
{
    const char* name;
    double ReportRow::*value;
};

constexpr Column kColumns[] = {
    {"budget", &ReportRow::budget},
    {"seconds", &ReportRow::seconds},
    {"passes", &ReportRow::passes},
    {"samples", &ReportRow::samples},
    {"rays", &ReportRow::rays},
    {"rel_mse", &ReportRow::relMse},
    {"rel_mse_error", &ReportRow::relMseError},
    {"rel_mse_fixed", &ReportRow::relMseFixed},
    {"mse", &ReportRow::mse},
    {"mse_error", &ReportRow::mseError},
    {"bias_percent", &ReportRow::biasPercent},
    {"bias_error_percent", &ReportRow::biasError},
    {"percentile_99_9", &ReportRow::percentile999},
    {"flip", &ReportRow::flip},
    {"variance", &ReportRow::variance},
    {"efficiency", &ReportRow::efficiency},
};

ordered_json number(double value)
{
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

double numberFrom(const ordered_json& value)
{
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

ordered_json rowJson(const ReportRow& row)
{
    ordered_json json{{"seeds", row.seeds}, {"non_finite", row.nonFinite}};
    for (const Column& column : kColumns)
        json[column.name] = number(row.*column.value);
    return json;
}

ReportRow rowFrom(const ordered_json& json)
{
    ReportRow row;
    row.seeds = json.at("seeds");
    row.nonFinite = json.at("non_finite");
    for (const Column& column : kColumns)
        row.*column.value = numberFrom(json.at(column.name));
    return row;
}

std::string targetName(double target)
{
    char text[16];
    std::snprintf(text, sizeof text, "%.0e", target);
    return text;
}

ordered_json lineJson(const ReportLine& line)
{
    ordered_json json{{"scene", line.scene},         {"placement", line.placement},
                      {"method", line.method},       {"reference", line.reference},
                      {"kernel", line.kernel},       {"build_seconds", line.buildSeconds},
                      {"slope", number(line.slope)}, {"slope_error", number(line.slopeError)}};
    for (std::size_t t = 0; t < kTargets.size(); ++t)
        json["seconds_to"][targetName(kTargets[t])] =
            line.secondsTo[t] ? ordered_json(*line.secondsTo[t]) : ordered_json(nullptr);
    json["rows"] = ordered_json::array();
    for (const ReportRow& row : line.rows)
        json["rows"].push_back(rowJson(row));
    return json;
}

ReportLine lineFrom(const ordered_json& json)
{
    ReportLine line;
    line.scene = json.at("scene");
    line.placement = json.at("placement");
    line.method = json.at("method");
    line.reference = json.at("reference");
    line.kernel = json.at("kernel");
    line.buildSeconds = json.at("build_seconds");
    line.slope = numberFrom(json.at("slope"));
    line.slopeError = numberFrom(json.at("slope_error"));
    for (std::size_t t = 0; t < kTargets.size(); ++t)
    {
        const ordered_json& seconds = json.at("seconds_to").at(targetName(kTargets[t]));
        if (!seconds.is_null()) line.secondsTo[t] = seconds.get<double>();
    }
    for (const ordered_json& row : json.at("rows"))
        line.rows.push_back(rowFrom(row));
    return line;
}

ordered_json samplerJson(const SamplerLine& line)
{
    ordered_json json{{"scene", line.scene},
                      {"strategy", line.strategy},
                      {"slope", number(line.slope)},
                      {"slope_error", number(line.slopeError)},
                      {"seconds_per_sample", line.secondsPerSample},
                      {"points", ordered_json::array()}};
    for (const SamplerPoint& point : line.points)
        json["points"].push_back(
            {{"samples", point.samples}, {"mse", point.mse}, {"mse_error", point.mseError}});
    return json;
}

SamplerLine samplerFrom(const ordered_json& json)
{
    SamplerLine line;
    line.scene = json.at("scene");
    line.strategy = json.at("strategy");
    line.slope = numberFrom(json.at("slope"));
    line.slopeError = numberFrom(json.at("slope_error"));
    line.secondsPerSample = json.at("seconds_per_sample");
    for (const ordered_json& point : json.at("points"))
        line.points.push_back({point.at("samples"), point.at("mse"), point.at("mse_error")});
    return line;
}

ordered_json scheduleJson(const ScheduleLine& line)
{
    ordered_json json{{"schedule", line.schedule}, {"points", ordered_json::array()}};
    for (const SchedulePoint& point : line.points)
        json["points"].push_back({{"passes", point.passes},
                                  {"bias_square", point.biasSquare},
                                  {"variance", point.variance},
                                  {"error", number(point.error)},
                                  {"exact_bias_square", point.exactBiasSquare},
                                  {"exact_variance", point.exactVariance}});
    return json;
}

ScheduleLine scheduleFrom(const ordered_json& json)
{
    ScheduleLine line;
    line.schedule = json.at("schedule");
    for (const ordered_json& point : json.at("points"))
        line.points.push_back({point.at("passes"), point.at("bias_square"), point.at("variance"),
                               numberFrom(point.at("error")), point.at("exact_bias_square"),
                               point.at("exact_variance")});
    return line;
}

} // namespace

void writeJson(const Report& report, const std::string& file)
{
    ordered_json json{{"format", kFormat},
                      {"machine", report.machine},
                      {"budgets", report.timed ? "seconds" : "passes"},
                      {"width", report.width},
                      {"lines", ordered_json::array()},
                      {"samplers", ordered_json::array()},
                      {"schedules", ordered_json::array()}};
    for (const ReportLine& line : report.lines)
        json["lines"].push_back(lineJson(line));
    for (const SamplerLine& line : report.samplers)
        json["samplers"].push_back(samplerJson(line));
    for (const ScheduleLine& line : report.schedules)
        json["schedules"].push_back(scheduleJson(line));
    app::writeText(file, json.dump(1) + "\n");
}

void writeCsv(const Report& report, const std::string& file)
{
    std::ostringstream csv;
    csv.imbue(std::locale::classic());
    csv.precision(9);
    csv << "scene,placement,method,seeds,non_finite";
    for (const Column& column : kColumns)
        csv << ',' << column.name;
    csv << ",slope,slope_error\n";
    for (const ReportLine& line : report.lines)
    {
        for (const ReportRow& row : line.rows)
        {
            csv << line.scene << ',' << line.placement << ',' << line.method << ',' << row.seeds
                << ',' << row.nonFinite;
            for (const Column& column : kColumns)
                csv << ',' << row.*column.value;
            csv << ',' << line.slope << ',' << line.slopeError << '\n';
        }
    }
    csv << "\nreceivers below,strategy,light samples,mse,mse_error,slope,slope_error\n";
    for (const SamplerLine& line : report.samplers)
    {
        for (const SamplerPoint& point : line.points)
            csv << line.scene << ",\"" << line.strategy << "\"," << point.samples << ','
                << point.mse << ',' << point.mseError << ',' << line.slope << ',' << line.slopeError
                << '\n';
    }
    csv << "\nschedule,passes,squared bias,variance,error,exact squared bias,exact variance\n";
    for (const ScheduleLine& line : report.schedules)
    {
        for (const SchedulePoint& point : line.points)
            csv << '"' << line.schedule << "\"," << point.passes << ',' << point.biasSquare << ','
                << point.variance << ',' << point.error << ',' << point.exactBiasSquare << ','
                << point.exactVariance << '\n';
    }
    app::writeText(file, csv.str());
}

Report readJson(const std::string& file)
{
    constexpr std::size_t kMostBytes = std::size_t(256) << 20;
    const engine::FileText read = engine::readTextFile(file, kMostBytes);
    if (!read.error.empty())
        throw app::Failure(app::kCannotLoad, "cannot read " + file + ": " + read.error);
    try
    {
        const ordered_json json = ordered_json::parse(read.text);
        if (json.at("format") != kFormat)
            throw app::Failure(app::kCannotLoad, file + " is a report of another format");
        Report report;
        for (const auto& [key, value] : json.at("machine").items())
            report.machine[key] = value;
        report.timed = json.at("budgets") == "seconds";
        report.width = json.at("width");
        for (const ordered_json& line : json.at("lines"))
            report.lines.push_back(lineFrom(line));
        for (const ordered_json& line : json.at("samplers"))
            report.samplers.push_back(samplerFrom(line));
        for (const ordered_json& line : json.at("schedules"))
            report.schedules.push_back(scheduleFrom(line));
        return report;
    }
    catch (const nlohmann::json::exception& error)
    {
        throw app::Failure(app::kCannotLoad, file + " is no report: " + error.what());
    }
}

} // namespace osgRayTrace::bench
