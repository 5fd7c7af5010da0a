// Reports.h - a small report for tests to change.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

inline osgRayTrace::bench::Report smallReport()
{
    using namespace osgRayTrace::bench;
    Report report;
    report.machine["cpu"] = "a \"quoted\" one";
    report.timed = false;
    report.width = 32;
    for (const char* placement : {"origin", "displaced"})
    {
        for (const char* method : {"WHITTED Sobol", "WHITTED random"})
        {
            ReportLine line;
            line.scene = "s1-square";
            line.placement = placement;
            line.method = method;
            line.reference = "formula";
            line.slope = -1.25;
            line.slopeError = 0.01;
            line.secondsTo[1] = 0.5;
            for (const double budget : {2.0, 4.0})
            {
                ReportRow row;
                row.budget = row.passes = budget;
                row.seeds = 16;
                row.seconds = 0.1 * budget;
                row.rays = 1e6 * budget;
                row.relMse = (line.method == "WHITTED Sobol" ? 1e-4 : 1e-2) / budget;
                row.relMseError = 0.02 * row.relMse;
                row.biasPercent = 0.01;
                row.biasError = 0.01;
                line.rows.push_back(row);
            }
            report.lines.push_back(line);
        }
    }
    ReportLine kernel = report.lines.front();
    kernel.scene = "s6-flat-mirror";
    kernel.method = "SPPM";
    kernel.kernel = true;
    kernel.slope = -0.7;
    for (ReportRow& row : kernel.rows)
    {
        row.variance = 1e-4 / row.budget;
        row.mse = row.variance + 1e-3 / (row.budget * row.budget);
        row.biasPercent = 0.2;
        row.biasError = 0.001; // many errors: a bound in errors would be wrong here
    }
    report.lines.push_back(kernel);
    for (const char* strategy : {"Sobol", "random"})
    {
        const bool sobol = std::string(strategy) == "Sobol";
        SamplerLine line{"open", strategy, {}, sobol ? -2.8 : -1.0, 0.02, 1e-8};
        line.points = {{16, 1e-3, 2e-5}, {64, sobol ? 2e-5 : 2.5e-4, 1e-6}};
        report.samplers.push_back(line);
    }
    ScheduleLine schedule{"GLOBAL, alpha 2/3", {}};
    schedule.points = {{1, 5e-7, 2e-6, 1e-8, 4e-7, 5e-6}, {8, 1e-7, 2e-7, 1e-9, 1e-7, 1e-6}};
    report.schedules.push_back(schedule);
    return report;
}
