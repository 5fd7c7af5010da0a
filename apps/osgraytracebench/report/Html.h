// Html.h - texts and numbers as HTML. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Returns the text with the characters replaced that HTML reads as marks.
std::string escaped(const std::string& text);

/// Returns the number by printf's format, a dash if it is not finite.
std::string number(double value, const char* format = "%.3g");

std::string withError(double value, double error);

/// Returns a table that the page's script can sort, in a box that scrolls sideways. Headings and
/// cells are HTML.
std::string table(const std::vector<std::string>& headings,
                  const std::vector<std::vector<std::string>>& rows);

/// Return the page's style sheet and script.
std::string reportStyle();
std::string reportScript();

} // namespace osgRayTrace::bench
