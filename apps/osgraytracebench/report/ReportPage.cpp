// ReportPage.cpp - writes the page. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ReportPage.h"

#include "apps/osgraytracebench/report/Plots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <locale>
#include <sstream>

namespace osgRayTrace::bench
{

namespace
{

constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;max-width:76em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.8em 0}td,th{padding:.15em .6em;text-align:right;"
    "border-bottom:1px solid "
    "#ddd;white-space:nowrap}th{background:#f4f4f4}td:first-child,th:first-child,"
    "td.l,th.l{text-align:left}img{image-rendering:pixelated;display:block}figure{display:inline-"
    "block;"
    "margin:0 .8em .8em 0;font-size:13px}.bad{color:#b00020;font-weight:bold}details{margin:.6em 0}"
    ".wide{overflow-x:auto}";

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text)
    {
        switch (c)
        {
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '&':
            result += "&amp;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string number(double value, const char* format = "%.3g")
{
    if (!std::isfinite(value)) return "&ndash;";
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string withError(double value, double error)
{
    return number(value, "%.3f") + " &plusmn; " + number(error, "%.3f");
}

template <typename... Cells> std::string row(const char* cell, const Cells&... cells)
{
    std::string text = "<tr>";
    for (const std::string& content : {std::string(cells)...})
        text += std::string("<") + cell + ">" + content + "</" + cell + ">";
    return text + "</tr>\n";
}

/// Returns the efficiency of the naive method on the line's scene and placement: relative to it
/// results carry over to other machines.
double naiveEfficiency(const Report& report, const ReportLine& line)
{
    for (const ReportLine& other : report.lines)
    {
        const bool same = other.scene == line.scene && other.placement == line.placement;
        if (same && other.method == "WHITTED random" && other.rows.size() == line.rows.size())
            return other.rows.back().efficiency;
    }
    return std::nan("");
}

std::string summaryTable(const Report& report, const std::vector<const ReportLine*>& lines)
{
    std::string table = "<div class=wide><table>" +
                        row("th", "method", "where", "s", "M rays/s", "relMSE", "&plusmn;",
                            "bias %", "in &sigma;", "99.9 % |x&minus;r|", "FLIP", "not finite",
                            "1/(V T)", "by random", "s to 1e-1", "1e-2", "1e-3", "1e-4", "slope");
    for (const ReportLine* line : lines)
    {
        const ReportRow& last = line->rows.back();
        std::array<std::string, kTargets.size()> times;
        for (std::size_t t = 0; t < times.size(); ++t)
            times[t] = number(line->secondsTo[t].value_or(std::nan("")));
        table += row("td", escaped(line->method), escaped(line->placement), number(last.seconds),
                     number(last.rays / last.seconds * 1e-6), number(last.relMse),
                     number(last.relMseError, "%.2g"), number(last.biasPercent, "%+.2g"),
                     number(last.biasPercent / last.biasError, "%+.1f"), number(last.percentile999),
                     number(last.flip), std::to_string(last.nonFinite), number(last.efficiency),
                     number(last.efficiency / naiveEfficiency(report, *line)), times[0], times[1],
                     times[2], times[3], withError(line->slope, line->slopeError));
    }
    return table + "</table></div>\n";
}

std::string allRows(const Report& report, const std::vector<const ReportLine*>& lines)
{
    std::string table =
        "<details><summary>All rows</summary><div class=wide><table>" +
        row("th", "method", "where", report.timed ? "budget s" : "passes", "seeds", "s",
            "samples a pixel", "rays", "relMSE", "&plusmn;", "relMSE (r&sup2; + 0.01)", "MSE",
            "bias %", "&plusmn;", "99.9 %", "FLIP", "not finite");
    for (const ReportLine* line : lines)
    {
        for (const ReportRow& r : line->rows)
            table +=
                row("td", escaped(line->method), escaped(line->placement), number(r.budget),
                    std::to_string(r.seeds), number(r.seconds), number(r.samples), number(r.rays),
                    number(r.relMse), number(r.relMseError, "%.2g"), number(r.relMseFixed),
                    number(r.mse), number(r.biasPercent, "%+.2g"), number(r.biasError, "%.2g"),
                    number(r.percentile999), number(r.flip), std::to_string(r.nonFinite));
    }
    return table + "</table></div></details>\n";
}

std::string figure(const std::string& image, const std::string& caption)
{
    return image.empty()
               ? ""
               : "<figure>" + image + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string sceneSection(const Report& report, const SceneThumbnails& pictures)
{
    std::vector<const ReportLine*> lines, atOrigin;
    for (const ReportLine& line : report.lines)
    {
        if (line.scene != pictures.scene) continue;
        lines.push_back(&line);
        if (line.placement == "origin") atOrigin.push_back(&line);
    }
    if (lines.empty()) return {};
    std::string text = "<h2>" + escaped(pictures.title) +
                       "</h2>\n<p>Compared with: " + escaped(lines.front()->reference) +
                       ". Conversion and BVH: " + number(1e3 * lines.front()->buildSeconds) +
                       " ms, not in the times below.</p>\n";
    text += errorPlot(atOrigin) + summaryTable(report, lines) + allRows(report, lines);
    text += figure(pictures.reference, "reference");
    for (const SceneThumbnails::Line& line : pictures.lines)
    {
        text += figure(line.picture, escaped(line.method) + ", " + line.budget);
        text += figure(line.error, "its relative error");
    }
    return text;
}

std::string samplerSection(const Report& report)
{
    if (report.samplers.empty()) return {};
    std::string text =
        "<h2>Strategies of sampling an area light</h2>\n<p>Mean squared error of E/L at single "
        "receivers "
        "against N, the light samples of one pass: the paper's Figure 3 as numbers. \"ratio\" is "
        "[HeitzHill18]: the formula of the open light times the sampled share that arrives, with "
        "the same "
        "samples; its time per sample includes the formula, one for each receiver. MSE &times; s "
        "compares "
        "at equal time, at the largest N, with Sobol's.</p>\n";
    std::vector<std::string> scenes;
    for (const SamplerLine& line : report.samplers)
    {
        if (std::find(scenes.begin(), scenes.end(), line.scene) == scenes.end())
            scenes.push_back(line.scene);
    }
    for (const std::string& scene : scenes)
    {
        std::vector<const SamplerLine*> lines;
        double sobol = 0.0;
        for (const SamplerLine& line : report.samplers)
        {
            if (line.scene != scene) continue;
            lines.push_back(&line);
            if (line.strategy == "Sobol") sobol = line.points.back().mse * line.secondsPerSample;
        }
        text += "<h3>" + escaped(scene) + "</h3>\n" + samplerPlot(lines);
        std::string head = "<tr><th>strategy</th>", body;
        for (const SamplerPoint& point : lines.front()->points)
            head += "<th>N = " + std::to_string(point.samples) + "</th>";
        for (const SamplerLine* line : lines)
        {
            body += "<tr><td>" + escaped(line->strategy) + "</td>";
            for (const SamplerPoint& point : line->points)
                body += "<td>" + number(point.mse) + "</td>";
            body += "<td>" + withError(line->slope, line->slopeError) + "</td><td>" +
                    number(1e9 * line->secondsPerSample) + "</td><td>" +
                    number(line->points.back().mse * line->secondsPerSample / sobol) +
                    "</td></tr>\n";
        }
        text += "<table>" + head +
                "<th>slope</th><th>ns a sample</th><th>MSE &times; s</th></tr>\n" + body +
                "</table>\n";
    }
    return text;
}

std::string scheduleSection(const Report& report)
{
    if (report.schedules.empty()) return {};
    std::string text =
        "<h2>Schedules of photon lookups</h2>\n<p>SPPM on the floor of S6 with a first radius that "
        "is known: squared bias and variance against the number of passes. Thin lines: what the "
        "recurrence of the global schedule [Knaus11] makes of the density's Laplacian and of "
        "independent photons; photons from Sobol points scatter less. LOCAL [Hachisuka08] is "
        "beside the lines of GLOBAL.</p>\n";
    text += schedulePlot(report.schedules);
    text += "<table>" + row("th", "schedule", "passes", "squared bias", "by the formula",
                            "variance", "by the formula");
    for (const ScheduleLine& line : report.schedules)
    {
        for (const SchedulePoint& point : line.points)
            text += row(
                "td", escaped(line.schedule), std::to_string(point.passes),
                number(point.biasSquare), number(point.biasSquare / point.exactBiasSquare, "%.3f"),
                number(point.variance), number(point.variance / point.exactVariance, "%.3f"));
    }
    return text + "</table>\n";
}

std::string verdictSection(const std::vector<Verdict>& verdicts)
{
    if (verdicts.empty()) return {};
    std::string text = "<h2>Checks</h2>\n<details><summary>";
    std::size_t failed = 0;
    std::string list;
    for (const Verdict& verdict : verdicts)
    {
        failed += verdict.met ? 0 : 1;
        list += std::string("<li") + (verdict.met ? ">" : " class=bad>FAILED: ") +
                escaped(verdict.text) + "</li>\n";
    }
    return text + std::to_string(verdicts.size()) + " checks, " + std::to_string(failed) +
           " failed</summary><ul>" + list + "</ul></details>\n";
}

} // namespace

std::string reportPage(const Report& report, const std::vector<SceneThumbnails>& thumbnails,
                       const std::vector<Verdict>& verdicts)
{
    std::ostringstream page;
    page.imbue(std::locale::classic());
    page << "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><title>osgRayTrace: speed "
            "against "
            "error</title><style>"
         << kStyle << "</style></head><body>\n<h1>osgRayTrace: speed against error</h1>\n<p>";
    for (const auto& [name, value] : report.machine)
        page << escaped(name) << ": " << escaped(value) << "<br>";
    page << "</p>\n<p>Pictures " << report.width
         << " pixels wide. relMSE = mean((x&minus;r)&sup2;/(r&sup2; + &epsilon;&sup2;)), &epsilon; "
            "= 1 % of the "
            "reference's mean luminance; a rendered reference's own variance is taken off. Each "
            "row is the mean "
            "over independent seeds; a seed's picture goes on from budget to budget. Budgets are "
         << (report.timed ? "seconds of rendering" : "passes")
         << ". Slopes are those of log relMSE over log " << (report.timed ? "seconds" : "passes")
         << ". Bias is that of the mean radiance, its &sigma; from the scatter of the pixels over "
            "the seeds. "
            "V: variance of a pixel, T: seconds. FLIP [Andersson20] at an exposure that brings the "
            "reference's mean luminance to 0.4. Error maps: black 1e-4 and below, through red and "
            "yellow to "
            "white, 1 and above. Bands in plots: one standard error.</p>\n";
    if (!haveGnuplot()) page << "<p class=bad>gnuplot was not found: there are no plots.</p>\n";
    page << verdictSection(verdicts);
    for (const SceneThumbnails& scene : thumbnails)
        page << sceneSection(report, scene);
    page << samplerSection(report) << scheduleSection(report) << "</body></html>\n";
    return page.str();
}

} // namespace osgRayTrace::bench
