// ReportPage.cpp - writes the page. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ReportPage.h"

#include "apps/osgraytracebench/report/Html.h"
#include "apps/osgraytracebench/report/Plots.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace osgRayTrace::bench
{

namespace
{

constexpr const char* kChecksTitle = "Checks";
constexpr const char* kSamplersTitle = "Strategies of sampling an area light";
constexpr const char* kSchedulesTitle = "Schedules of photon lookups";

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

using Rows = std::vector<std::vector<std::string>>;

std::string summaryTable(const Report& report, const std::vector<const ReportLine*>& lines)
{
    Rows rows;
    for (const ReportLine* line : lines)
    {
        const ReportRow& last = line->rows.back();
        std::array<std::string, kTargets.size()> times;
        for (std::size_t t = 0; t < times.size(); ++t)
            times[t] = number(line->secondsTo[t].value_or(std::nan("")));
        rows.push_back({escaped(line->method), escaped(line->placement), number(last.seconds),
                        number(last.rays / last.seconds * 1e-6), number(last.relMse),
                        number(last.relMseError, "%.2g"), number(last.biasPercent, "%+.2g"),
                        number(last.biasPercent / last.biasError, "%+.1f"),
                        number(last.percentile999), number(last.flip),
                        std::to_string(last.nonFinite), number(last.efficiency),
                        number(last.efficiency / naiveEfficiency(report, *line)), times[0],
                        times[1], times[2], times[3], withError(line->slope, line->slopeError)});
    }
    return table({"method", "where", "s", "M rays/s", "relMSE", "&plusmn;", "bias %", "in &sigma;",
                  "99.9 % |x&minus;r|", "FLIP", "not finite", "1/(V T)", "by random", "s to 1e-1",
                  "s to 1e-2", "s to 1e-3", "s to 1e-4", "slope"},
                 rows);
}

std::string allRows(const Report& report, const std::vector<const ReportLine*>& lines)
{
    Rows rows;
    for (const ReportLine* line : lines)
    {
        for (const ReportRow& r : line->rows)
            rows.push_back({escaped(line->method), escaped(line->placement), number(r.budget),
                            std::to_string(r.seeds), number(r.seconds), number(r.samples),
                            number(r.rays), number(r.relMse), number(r.relMseError, "%.2g"),
                            number(r.relMseFixed), number(r.mse), number(r.biasPercent, "%+.2g"),
                            number(r.biasError, "%.2g"), number(r.percentile999), number(r.flip),
                            std::to_string(r.nonFinite)});
    }
    return "<details><summary>All rows</summary>" +
           table({"method", "where", report.timed ? "budget s" : "passes", "seeds", "s",
                  "samples a pixel", "rays", "relMSE", "&plusmn;", "relMSE (r&sup2; + 0.01)", "MSE",
                  "bias %", "&plusmn;", "99.9 %", "FLIP", "not finite"},
                 rows) +
           "</details>\n";
}

std::string figure(const std::string& images, const std::string& caption)
{
    if (images.empty()) return {};
    return "<figure><div class=images>" + images + "</div><figcaption>" + caption +
           "</figcaption></figure>\n";
}

std::string heading(const std::string& id, const std::string& title)
{
    return "<section id=\"" + escaped(id) + "\"><h2>" + escaped(title) + "</h2>\n";
}

bool hasLines(const Report& report, const std::string& scene)
{
    return std::any_of(report.lines.begin(), report.lines.end(),
                       [&](const ReportLine& line) { return line.scene == scene; });
}

std::string sceneSection(const Report& report, const SceneThumbnails& pictures)
{
    if (!hasLines(report, pictures.scene)) return {};
    std::vector<const ReportLine*> lines, atOrigin;
    for (const ReportLine& line : report.lines)
    {
        if (line.scene != pictures.scene) continue;
        lines.push_back(&line);
        if (line.placement == "origin") atOrigin.push_back(&line);
    }
    std::string text = heading(pictures.scene, pictures.title) +
                       "<p>Compared with: " + escaped(lines.front()->reference) +
                       ". Conversion and BVH: " + number(1e3 * lines.front()->buildSeconds) +
                       " ms, not in the times below.</p>\n";
    text += errorPlot(atOrigin) + summaryTable(report, lines) + allRows(report, lines);
    text += "<div class=pictures>\n" + figure(pictures.reference, "reference");
    for (const SceneThumbnails::Line& line : pictures.lines)
        text += figure(line.picture + line.error,
                       escaped(line.method) + ", " + line.budget + ", and its relative error");
    return text + "</div></section>\n";
}

std::string samplerSection(const Report& report)
{
    if (report.samplers.empty()) return {};
    std::string text =
        heading("samplers", kSamplersTitle) +
        "<p>Mean squared error of E/L at single "
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
        std::vector<std::string> headings{"strategy"};
        for (const SamplerPoint& point : lines.front()->points)
            headings.push_back("N = " + std::to_string(point.samples));
        for (const char* last : {"slope", "ns a sample", "MSE &times; s"})
            headings.emplace_back(last);
        Rows rows;
        for (const SamplerLine* line : lines)
        {
            std::vector<std::string> cells{escaped(line->strategy)};
            for (const SamplerPoint& point : line->points)
                cells.push_back(number(point.mse));
            cells.push_back(withError(line->slope, line->slopeError));
            cells.push_back(number(1e9 * line->secondsPerSample));
            cells.push_back(number(line->points.back().mse * line->secondsPerSample / sobol));
            rows.push_back(cells);
        }
        text += table(headings, rows);
    }
    return text + "</section>\n";
}

std::string scheduleSection(const Report& report)
{
    if (report.schedules.empty()) return {};
    std::string text =
        heading("schedules", kSchedulesTitle) +
        "<p>SPPM on the floor of S6 with a first radius that "
        "is known: squared bias and variance against the number of passes. Thin lines: what the "
        "recurrence of the global schedule [Knaus11] makes of the density's Laplacian and of "
        "independent photons; photons from Sobol points scatter less. LOCAL [Hachisuka08] is "
        "beside the lines of GLOBAL.</p>\n";
    text += schedulePlot(report.schedules);
    Rows rows;
    for (const ScheduleLine& line : report.schedules)
    {
        for (const SchedulePoint& point : line.points)
            rows.push_back(
                {escaped(line.schedule), std::to_string(point.passes), number(point.biasSquare),
                 number(point.biasSquare / point.exactBiasSquare, "%.3f"), number(point.variance),
                 number(point.variance / point.exactVariance, "%.3f")});
    }
    return text +
           table({"schedule", "passes", "squared bias", "by the formula", "variance",
                  "by the formula"},
                 rows) +
           "</section>\n";
}

std::string verdictSection(const std::vector<Verdict>& verdicts)
{
    if (verdicts.empty()) return {};
    std::size_t failed = 0;
    std::string list;
    for (const Verdict& verdict : verdicts)
    {
        failed += verdict.met ? 0 : 1;
        list += std::string("<li") + (verdict.met ? ">" : " class=bad>FAILED: ") +
                escaped(verdict.text) + "</li>\n";
    }
    return heading("checks", kChecksTitle) + "<details class=checks" + (failed ? " open" : "") +
           "><summary>" + std::to_string(verdicts.size()) + " checks, " + std::to_string(failed) +
           " failed</summary><ul>" + list + "</ul></details></section>\n";
}

std::string contents(const Report& report, const std::vector<SceneThumbnails>& thumbnails,
                     bool checked)
{
    std::string text = "<nav aria-label=Contents><ul>\n";
    const auto add = [&](const std::string& id, const std::string& title)
    { text += "<li><a href=\"#" + escaped(id) + "\">" + escaped(title) + "</a></li>\n"; };
    if (checked) add("checks", kChecksTitle);
    for (const SceneThumbnails& scene : thumbnails)
        if (hasLines(report, scene.scene)) add(scene.scene, scene.title);
    if (!report.samplers.empty()) add("samplers", kSamplersTitle);
    if (!report.schedules.empty()) add("schedules", kSchedulesTitle);
    return text + "</ul></nav>\n";
}

/// Returns the head of the page. Its policy lets a browser load nothing from elsewhere.
std::string head()
{
    return "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8>\n"
           "<meta name=viewport content=\"width=device-width, initial-scale=1\">\n"
           "<meta http-equiv=Content-Security-Policy content=\"default-src 'none'; img-src data:; "
           "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
           "<link rel=icon href=\"data:,\">\n<title>osgRayTrace: speed against error</title>\n"
           "<style>\n" +
           reportStyle() + "</style></head>\n";
}

std::string machineList(const Report& report)
{
    std::string text = "<dl class=machine>";
    for (const auto& [name, value] : report.machine)
        text += "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>";
    return text + "</dl>\n";
}

} // namespace

std::string reportPage(const Report& report, const std::vector<SceneThumbnails>& thumbnails,
                       const std::vector<Verdict>& verdicts)
{
    std::ostringstream page;
    page.imbue(std::locale::classic());
    page << head() << "<body>\n<h1>osgRayTrace: speed against error</h1>\n"
         << machineList(report) << "<p>Pictures " << report.width
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
            "reference's mean luminance to 0.4. Bands in plots: one standard error. Headings sort "
            "their "
            "table. Error maps show the relative error of each pixel:</p>\n"
            "<div class=scale><i></i><span>&le; 1e-4</span><span>1e-2</span>"
            "<span>&ge; 1</span></div>\n";
    if (!haveGnuplot()) page << "<p class=bad>gnuplot was not found: there are no plots.</p>\n";
    page << contents(report, thumbnails, !verdicts.empty()) << verdictSection(verdicts);
    for (const SceneThumbnails& scene : thumbnails)
        page << sceneSection(report, scene);
    page << samplerSection(report) << scheduleSection(report) << "<script>\n"
         << reportScript() << "</script></body></html>\n";
    return page.str();
}

} // namespace osgRayTrace::bench
