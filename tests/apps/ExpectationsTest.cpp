// ExpectationsTest.cpp - each check of a quick report can fail.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Reports.h"

#include "apps/common/Failure.h"
#include "apps/osgraytracebench/report/Expectations.h"

using namespace osgRayTrace::bench;

namespace
{

const std::string kExpectations = R"({
  "non_finite": 0,
  "bias": { "largest_percent": 0.1, "largest_errors": 4 },
  "kernels": [ { "scene": "s6-flat-mirror", "method": "SPPM", "largest_percent": 0.25,
                 "bias_square_left": 0.3, "bias_square": 1.3e-4, "slope": [-1.0, -0.6] } ],
  "placements": { "largest_errors": 4 },
  "sampler_slopes": [ { "scene": "open", "strategy": "Sobol", "at_most": -2.5 },
                      { "scene": "open", "strategy": "random", "at_most": -0.9, "at_least": -1.1 } ],
  "sampler_orders": [ { "scene": "open", "samples": 64, "best_first": ["Sobol", "random"] } ],
  "schedules": [ { "schedule": "GLOBAL, alpha 2/3", "bias_square": [0.7, 1.4], "variance_at_most": 0.5 } ],
  "method_ratios": [ { "scene": "s1-square", "method": "WHITTED Sobol", "over": "WHITTED random", "at_most": 0.02 } ]
})";

int failures(const Report& report)
{
    int count = 0;
    for (const Verdict& verdict : checkExpectations(report, kExpectations))
        count += verdict.met ? 0 : 1;
    return count;
}

} // namespace

TEST_CASE("expectations: a report that meets all of them", "[report]")
{
    CHECK(failures(smallReport()) == 0);
}

TEST_CASE("expectations: each can be missed", "[report]")
{
    Report report = smallReport();
    SECTION("bias in percent")
    {
        report.lines[0].rows[1].biasPercent = report.lines[2].rows[1].biasPercent = 0.2;
        report.lines[0].rows[1].biasError = report.lines[2].rows[1].biasError = 0.1;
        CHECK(failures(report) == 2);
    }
    SECTION("bias against its error")
    {
        report.lines[0].rows[1].biasError = report.lines[2].rows[1].biasError = 0.002;
        CHECK(failures(report) == 2);
    }
    SECTION("the mean under a kernel")
    {
        report.lines[4].rows[1].biasPercent = -0.3;
        CHECK(failures(report) == 1);
    }
    SECTION("a kernel's bias that stays")
    {
        report.lines[4].rows[1].mse = 1.5e-4;
        CHECK(failures(report) == 1);
    }
    SECTION("a kernel's bias that is too large, though it fell")
    {
        std::vector<ReportRow>& rows = report.lines[4].rows;
        rows[0].mse = rows[0].variance + 1e-2;
        rows[1].mse = rows[1].variance + 2e-4;
        CHECK(failures(report) == 1);
    }
    SECTION("a kernel's bias that was never there cannot have fallen")
    {
        report.lines[4].rows[0].mse = report.lines[4].rows[0].variance;
        CHECK(failures(report) == 1);
    }
    SECTION("the slope of a method with a kernel, either way")
    {
        report.lines[4].slope = GENERATE(-0.5, -1.1);
        CHECK(failures(report) == 1);
    }
    SECTION("a method with a kernel that nothing is expected of")
    {
        report.lines[4].method = "PPM";
        CHECK(failures(report) == 2); // SPPM was not measured either
    }
    SECTION("the displaced mean")
    {
        report.lines[2].rows[1].biasPercent = -0.035;
        report.lines[0].rows[1].biasPercent = 0.03;
        CHECK(failures(report) == 1);
    }
    SECTION("the displaced error")
    {
        report.lines[2].rows[1].relMse *= 1.2;
        CHECK(failures(report) == 1);
    }
    SECTION("non-finite samples")
    {
        report.lines[1].rows[0].nonFinite = 1;
        CHECK(failures(report) == 1);
    }
    SECTION("a slope")
    {
        report.samplers[0].slope = -2.4;
        CHECK(failures(report) == 1);
    }
    SECTION("a slope that is too steep to be true")
    {
        report.samplers[1].slope = -1.5;
        CHECK(failures(report) == 1);
    }
    SECTION("the squared bias of a schedule, either way")
    {
        report.schedules[0].points[1].biasSquare = GENERATE(5e-8, 2e-7, -1e-8);
        CHECK(failures(report) == 1);
    }
    SECTION("the variance of a schedule, too much and none at all")
    {
        report.schedules[0].points[1].variance = GENERATE(6e-7, 0.0);
        CHECK(failures(report) == 1);
    }
    SECTION("an order")
    {
        report.samplers[0].points[1].mse = 1e-3;
        CHECK(failures(report) == 1);
    }
    SECTION("a ratio")
    {
        report.lines[0].rows[1].relMse *= 3.0;
        report.lines[2].rows[1].relMse *= 3.0;
        CHECK(failures(report) == 1);
    }
}

TEST_CASE("expectations: what was not measured is not met", "[report]")
{
    Report report = smallReport();
    report.schedules.clear();
    CHECK(failures(report) == 1);
    report.samplers.clear();
    CHECK(failures(report) == 4);
    report.lines.clear();
    CHECK(failures(report) == 7);
    CHECK_THROWS_AS(checkExpectations(report, "{}"), osgRayTrace::app::Failure);
    CHECK_NOTHROW(checkExpectations(report, builtInExpectations()));
}
