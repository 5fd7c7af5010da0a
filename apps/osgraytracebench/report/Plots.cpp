// Plots.cpp - scripts for gnuplot, and their output. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Plots.h"

#include "apps/osgraytracebench/report/Html.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>
#include <unistd.h>

namespace osgRayTrace::bench
{

namespace
{

/// These colours are distinct for most kinds of colour blindness (Okabe and Ito's).
constexpr const char* kColours[] = {"#999999", "#E69F00", "#56B4E9", "#D55E00",
                                    "#009E73", "#CC79A7", "#0072B2", "#000000"};

struct Point
{
    double x, y, error;
};

struct Curve
{
    std::string name;
    std::vector<Point> points;
    bool exact = false; ///< true: a formula, as a thin line of the next curve's colour
};

struct Guide
{
    double slope;
    const char* name;
};

/// Returns the output of gnuplot for the script; empty if it fails.
std::string gnuplot(const std::string& script)
{
    std::string pattern =
        (std::filesystem::temp_directory_path() / "osgraytracebenchXXXXXX").string();
    const int handle = mkstemp(pattern.data());
    if (handle < 0) return {};
    close(handle);
    std::ofstream(pattern) << script;
    std::string output;
    if (std::FILE* pipe = popen(("gnuplot '" + pattern + "' 2>/dev/null").c_str(), "r"))
    {
        std::array<char, 4096> buffer;
        while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
            output.append(buffer.data(), count);
        if (pclose(pipe) != 0) output.clear();
    }
    std::filesystem::remove(pattern);
    return output;
}

std::string svgPart(const std::string& document)
{
    const std::size_t begin = document.find("<svg");
    return begin == std::string::npos ? std::string() : document.substr(begin);
}

/// Returns the plot with names that no other plot of the page has.
std::string withOwnNames(std::string svg)
{
    static int plots = 0;
    const std::string own = "p" + std::to_string(++plots) + "-";
    for (const std::string start : {"id='", "id=\"", "href='#", "url(#"})
    {
        for (std::size_t at = svg.find(start); at != std::string::npos; at = svg.find(start, at))
            svg.insert(at += start.size(), own);
    }
    return svg;
}

/// Holds powers of ten that enclose all values.
struct Range
{
    double low = 1e300, high = 0.0;

    void add(double value)
    {
        if (!(value > 0.0)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    double bottom() const { return std::pow(10.0, std::floor(std::log10(low) - 0.05)); }
    double top() const { return std::pow(10.0, std::ceil(std::log10(high) + 0.05)); }
};

struct Axes
{
    Range xs, ys;
    std::string xLabel, yLabel;
};

void writeAxes(std::ostream& script, const Axes& axes)
{
    static int number = 0;
    script << "set terminal svg size 520,360 dynamic font 'sans-serif,14' name 'plot" << ++number
           << "'\n"
           << "set logscale xy\nset format x '10^{%T}'\nset format y '10^{%T}'\nset grid lc rgb "
              "'#dddddd'\n"
           << "unset key\nset style fill transparent solid "
              "0.2 noborder\n"
           << "set xlabel '" << axes.xLabel << "'\nset ylabel '" << axes.yLabel << "'\n"
           << "set xrange [" << 0.8 * axes.xs.low << ':' << 1.25 * axes.xs.high << "]\n"
           << "set yrange [" << axes.ys.bottom() << ':' << axes.ys.top() << "]\n";
}

/// The points of curve c and their error bars, as a block of data.
void writeData(std::ostream& script, const Curve& curve, std::size_t c)
{
    script << "$curve" << c << " << EOD\n";
    for (const Point& point : curve.points)
    {
        if (!(point.y > 0.0)) continue;
        const double error = std::isfinite(point.error) ? point.error : 0.0;
        script << point.x << ' ' << point.y << ' ' << std::max(point.y - error, 1e-3 * point.y)
               << ' ' << point.y + error << '\n';
    }
    script << "EOD\n";
}

/// Returns the dashes of a guide, as lengths; none: a whole line.
const char* dashesOf(double slope)
{
    if (slope < -2.5) return "9,3,2,3";
    if (slope < -1.75) return "2,3";
    if (slope < -1.25) return "4,4";
    return slope < -0.8 ? "9,4" : "";
}

std::string gnuplotDashes(double slope)
{
    const std::string dashes = dashesOf(slope);
    return dashes.empty() ? "1" : "(" + dashes + ")";
}

constexpr const char* kGuideColour = "#888888";

std::string legendEntry(const std::string& colour, const std::string& more, const std::string& name)
{
    return "<li><svg viewBox=\"0 0 30 10\" aria-hidden=true><path d=\"M0 5H30\" stroke=\"" +
           colour + "\" " + more + "/></svg>" + escaped(name) + "</li>";
}

/// Returns the legend as text, which wraps on narrow pages.
std::string legend(const std::vector<Curve>& curves, const std::vector<Guide>& guides)
{
    std::string text = "<ul class=legend>";
    std::size_t coloured = 0;
    for (const Curve& curve : curves)
    {
        if (curve.exact) continue;
        const std::string colour = kColours[coloured++ % std::size(kColours)];
        text += legendEntry(colour, "stroke-width=\"3\"", curve.name);
    }
    for (const Guide& guide : guides)
        text += legendEntry(kGuideColour,
                            std::string("stroke-dasharray=\"") + dashesOf(guide.slope) + "\"",
                            std::string("slope ") + guide.name);
    return text + "</ul>";
}

void writeCurves(std::ostream& script, const std::vector<Curve>& curves)
{
    std::size_t coloured = 0;
    for (std::size_t c = 0; c < curves.size(); ++c)
    {
        const char* colour = kColours[coloured % std::size(kColours)];
        if (curves[c].exact)
        {
            script << "$curve" << c << " using 1:2 with lines lw 1 lc rgb '" << colour
                   << "' notitle, ";
            continue;
        }
        ++coloured;
        script << "$curve" << c << " using 1:3:4 with filledcurves lc rgb '" << colour
               << "' notitle, $curve" << c << " using 1:2 with "
               << (c > 0 && curves[c - 1].exact ? "points" : "linespoints lw 2")
               << " pt 7 ps 0.5 lc rgb '" << colour << "' notitle"
               << (c + 1 < curves.size() ? ", " : "\n");
    }
}

std::string plot(const std::vector<Curve>& curves, const std::vector<Guide>& guides,
                 const std::string& xLabel, const std::string& yLabel)
{
    Axes axes{{}, {}, xLabel, yLabel};
    for (const Curve& curve : curves)
        for (const Point& point : curve.points)
        {
            axes.xs.add(point.x);
            axes.ys.add(point.y);
        }
    if (axes.ys.high <= 0.0) return {};

    std::ostringstream script;
    script.imbue(std::locale::classic());
    writeAxes(script, axes);
    for (std::size_t c = 0; c < curves.size(); ++c)
        writeData(script, curves[c], c);
    script << "plot ";
    for (const Guide& guide : guides)
        script << axes.ys.high << "*(x/" << axes.xs.low << ")**(" << guide.slope
               << ") with lines lw 1 dt " << gnuplotDashes(guide.slope) << " lc rgb '"
               << kGuideColour << "' notitle, ";
    writeCurves(script, curves);
    const std::string svg = svgPart(gnuplot(script.str()));
    if (svg.empty()) return {};
    return "<figure class=plot>" + withOwnNames(svg) + legend(curves, guides) + "</figure>\n";
}

} // namespace

bool haveGnuplot()
{
    static const bool have = std::system("gnuplot --version >/dev/null 2>&1") == 0;
    return have;
}

std::string errorPlot(const std::vector<const ReportLine*>& lines)
{
    if (!haveGnuplot()) return {};
    std::vector<Curve> curves;
    for (const ReportLine* line : lines)
    {
        Curve curve{line->method, {}};
        for (const ReportRow& row : line->rows)
            curve.points.push_back({row.seconds, row.relMse, row.relMseError});
        curves.push_back(curve);
    }
    return plot(curves, {{-2.0 / 3.0, "-2/3"}, {-1.0, "-1"}, {-1.5, "-3/2"}, {-2.0, "-2"}},
                "seconds", "relMSE");
}

std::string samplerPlot(const std::vector<const SamplerLine*>& lines)
{
    if (!haveGnuplot()) return {};
    std::vector<Curve> curves;
    for (const SamplerLine* line : lines)
    {
        Curve curve{line->strategy, {}};
        for (const SamplerPoint& point : line->points)
            curve.points.push_back({static_cast<double>(point.samples), point.mse, point.mseError});
        curves.push_back(curve);
    }
    return plot(curves, {{-1.0, "-1"}, {-1.5, "-3/2"}, {-2.0, "-2"}, {-3.0, "-3"}},
                "light samples N", "mean squared error of E/L");
}

std::string schedulePlot(const std::vector<ScheduleLine>& lines)
{
    if (!haveGnuplot()) return {};
    std::vector<Curve> curves;
    for (const bool bias : {true, false})
    {
        for (const ScheduleLine& line : lines)
        {
            Curve exact{"", {}, true};
            Curve measured{(bias ? "bias^2, " : "variance, ") + line.schedule, {}};
            for (const SchedulePoint& point : line.points)
            {
                const double x = point.passes;
                exact.points.push_back(
                    {x, bias ? point.exactBiasSquare : point.exactVariance, 0.0});
                measured.points.push_back({x, bias ? point.biasSquare : point.variance, 0.0});
            }
            curves.push_back(exact);
            curves.push_back(measured);
        }
    }
    return plot(curves, {{-2.0 / 3.0, "-2/3"}, {-1.0, "-1"}}, "passes N",
                "squared bias and variance of the radiance");
}

} // namespace osgRayTrace::bench
