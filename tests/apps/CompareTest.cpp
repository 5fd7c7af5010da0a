// CompareTest.cpp - comparison of reports with each other, and through their files.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/CommaLocale.h"
#include "tests/Statistics.h"
#include "tests/apps/Reports.h"
#include "tests/plugins/TemporaryFolder.h"

#include "apps/common/Failure.h"
#include "apps/osgraytracebench/report/CompareMode.h"
#include "apps/osgraytracebench/report/ReportFiles.h"

#include <cmath>
#include <fstream>
#include <limits>

using namespace osgRayTrace::bench;
using osgRayTrace::engine::test::Uniform;

TEST_CASE("compare: a report equals itself, also through its file", "[report]")
{
    const TemporaryFolder folder;
    Report report = smallReport();
    report.lines[0].rows[0].relMseError = std::numeric_limits<double>::infinity();
    writeJson(report, folder / "a.json");
    const Report read = readJson(folder / "a.json");
    CHECK(read.machine == report.machine);
    CHECK(read.timed == report.timed);
    REQUIRE(read.lines.size() == 5);
    CHECK(read.lines[4].kernel);
    CHECK(read.lines[4].rows[1].variance == report.lines[4].rows[1].variance);
    CHECK_FALSE(read.lines[0].kernel);
    CHECK(read.lines[0].rows[0].relMse == report.lines[0].rows[0].relMse);
    CHECK(std::isinf(read.lines[0].rows[0].relMseError));
    CHECK(read.lines[0].secondsTo == report.lines[0].secondsTo);
    CHECK(read.samplers[1].points[1].mse == report.samplers[1].points[1].mse);

    const Comparison comparison = compareReports(report, read, 0.01);
    CHECK(comparison.changes.empty());
    CHECK(comparison.onlyInOne == 0);
    CHECK(comparison.tests == 10 * 2 + 4);
    CHECK(runCompare(folder / "a.json", folder / "a.json", 0.01) == 0);
}

TEST_CASE("compare: what changed beyond its noise is named, nothing else", "[report]")
{
    Report changed = smallReport();
    changed.lines[1].rows[1].relMse *= 1.25;      // 8.8 of its standard errors
    changed.lines[2].rows[0].relMse *= 1.03;      // 1.1
    changed.lines[3].rows[0].biasPercent += 0.08; // 5.7
    changed.lines[0].rows[0].nonFinite = 1;
    changed.samplers[0].points[1].mse *= 1.6;
    const Comparison comparison = compareReports(smallReport(), changed, 0.01);
    std::vector<std::string> named;
    for (const Change& change : comparison.changes)
        named.push_back(change.row + ": " + change.quantity);
    CHECK_THAT(named, Catch::UnorderedEquals(std::vector<std::string>{
                          "s1-square, origin, WHITTED Sobol, 2 passes: non-finite samples",
                          "s1-square, origin, WHITTED random, 4 passes: relMSE",
                          "s1-square, displaced, WHITTED random, 2 passes: bias [%]",
                          "samplers, open, Sobol, N = 64: MSE"}));
}

// There are 300 comparisons of 8 rows whose values are drawn anew, with 2 quantities each, at a
// rate of 10 %.
TEST_CASE("compare: false alarms come as often as stated", "[report]")
{
    Uniform random(7);
    const auto normal = [&random]
    {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i)
            sum += random();
        return sum;
    };
    // As in a report, each row has the mean and the standard error of 16 pictures.
    const auto redraw = [&normal](Report report)
    {
        report.samplers.clear();
        for (ReportLine& line : report.lines)
        {
            for (ReportRow& row : line.rows)
            {
                double sum = 0.0, squares = 0.0;
                for (int seed = 0; seed < 16; ++seed)
                {
                    const double value = row.relMse * (1.0 + 0.08 * normal());
                    sum += value;
                    squares += value * value;
                }
                row.relMse = sum / 16;
                row.relMseError = std::sqrt((squares / 16 - row.relMse * row.relMse) / 15);
                row.biasPercent = row.biasError * normal();
            }
        }
        return report;
    };
    int alarms = 0;
    for (int run = 0; run < 300; ++run)
    {
        const Report before = redraw(smallReport()), after = redraw(smallReport());
        alarms += compareReports(before, after, 0.1).changes.empty() ? 0 : 1;
    }
    CHECK(alarms >= 30 - 21); // 4 standard deviations of the binomial distribution
    CHECK(alarms <= 30 + 21);
}

TEST_CASE("compare: files that cannot be compared", "[report]")
{
    const TemporaryFolder folder;
    writeJson(smallReport(), folder / "a.json");
    Report other = smallReport();
    for (ReportLine& line : other.lines)
        line.scene = "elsewhere";
    other.samplers.clear();
    writeJson(other, folder / "other.json");
    std::ofstream(folder / "broken.json") << "{ \"lines\": [";
    std::ofstream(folder / "foreign.json") << "{ \"rows\": [] }";
    for (const char* file : {"missing.json", "broken.json", "foreign.json", "other.json"})
        CHECK(runCompare(folder / "a.json", folder / file, 0.01) == 2);
    CHECK_THROWS_AS(readJson(folder / "foreign.json"), osgRayTrace::app::Failure);
    CHECK_THROWS_AS(writeJson(other, folder / "nowhere/a.json"), osgRayTrace::app::Failure);

    other = smallReport();
    other.lines[0].rows[0].relMse *= 2.0;
    writeJson(other, folder / "changed.json");
    CHECK(runCompare(folder / "a.json", folder / "changed.json", 0.01) == 1);
}

TEST_CASE("compare: single pictures are not judged", "[report]")
{
    Report one = smallReport(), other = smallReport();
    for (Report* report : {&one, &other})
    {
        report->lines[0].rows[0].seeds = 1;
        report->lines[0].rows[0].relMseError = std::numeric_limits<double>::infinity();
    }
    other.lines[0].rows[0].relMse *= 10.0;
    const Comparison comparison = compareReports(one, other, 0.01);
    CHECK(comparison.changes.empty());
    CHECK(comparison.untested == 1);
}

TEST_CASE("reports: numbers have a point in any locale", "[report]")
{
    const TemporaryFolder folder;
    const Report report = smallReport();
    writeCsv(report, folder / "a.csv");
    writeJson(report, folder / "a.json");
    const CommaLocale commas;
    writeCsv(report, folder / "b.csv");
    writeJson(report, folder / "b.json");
    for (const char* extension : {".csv", ".json"})
    {
        std::ifstream a(folder / (std::string("a") + extension));
        std::ifstream b(folder / (std::string("b") + extension));
        const std::string text(std::istreambuf_iterator<char>(a), {});
        CHECK(text.size() > 100);
        CHECK(text == std::string(std::istreambuf_iterator<char>(b), {}));
    }
}
