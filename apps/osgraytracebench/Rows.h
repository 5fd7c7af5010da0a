// Rows.h - the result of a benchmark: rows for people and for programs. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

enum class Goal
{
    None,    ///< for information
    AtLeast,
    AtMost,
};

struct Row
{
    std::string name;
    double value = 0.0;
    std::string unit;
    Goal goal = Goal::None;
    double bound = 0.0;

    bool meets() const;
};

using Rows = std::vector<Row>;

/// A table on standard output.
void printRows(const Rows& rows);

/// Whether writeRows will be able to: to be asked before minutes of measuring.
bool canWriteRows(const std::string& file);

/// {"rows":[{"name","value","unit","goal","meets"}, ...]}; goal is null for rows without one. False if the
/// file cannot be written; then there is none.
bool writeRows(const Rows& rows, const std::string& file);

} // namespace osgRayTrace::bench
