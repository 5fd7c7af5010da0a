// Rows.h - the result of a benchmark: rows for people and for programs. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

enum class Goal
{
    None, ///< for information
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

/// A signal has come: no more shall be measured.
struct Interrupted
{
};

/// Throws Interrupted if one has.
void endIfInterrupted();

/// Of what is measured one after the other.
class Rows
{
public:
    /// Ends as endIfInterrupted, with the row.
    void push_back(Row row);

    const std::vector<Row>& list() const { return _list; }

private:
    std::vector<Row> _list;
};

/// A table on standard output.
void printRows(const Rows& rows);

/// {"rows":[{"name","value","unit","goal","meets"}, ...]}; goal is null for rows without one.
/// Throws app::Failure(kCannotWrite).
void writeRows(const Rows& rows, const std::string& file);

} // namespace osgRayTrace::bench
