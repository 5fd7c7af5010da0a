// Expectations.h - ratios and slopes, never seconds, that a quick report must show. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/Report.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Holds one line for each check; failed checks are marked.
struct Verdict
{
    std::string text;
    bool met = true;
};

/// Returns checks against the text of data/report_expectations.json, which documents itself. Throws
/// app::Failure(kCannotLoad) if it is not such a text.
std::vector<Verdict> checkExpectations(const Report& report, const std::string& expectations);

/// Returns the file as it was when this program was built.
std::string builtInExpectations();

} // namespace osgRayTrace::bench
