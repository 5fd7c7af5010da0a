// Expectations.h - what a quick report must show: ratios and slopes, never seconds. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// One line for each check, those that failed marked.
struct Verdict
{
    std::string text;
    bool met = true;
};

/// Checks against the text of data/report_expectations.json, which documents itself. Throws
/// app::Failure(kCannotLoad) if it is not such a text.
std::vector<Verdict> checkExpectations(const Report& report, const std::string& expectations);

/// The file as it was when this program was built.
std::string builtInExpectations();

} // namespace osgRayTrace::bench
