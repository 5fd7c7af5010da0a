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

/// Is thrown after a signal: no more shall be measured.
struct Interrupted
{
};

/// Throws Interrupted if a signal has come.
void endIfInterrupted();

/// Holds the rows of measurements that run one after the other.
class Rows
{
public:
    /// Adds a row, then calls endIfInterrupted.
    void push_back(Row row);

    const std::vector<Row>& list() const { return _list; }

private:
    std::vector<Row> _list;
};

/// Prints a table on standard output.
void printRows(const Rows& rows);

/// Writes {"rows":[{"name","value","unit","goal","meets"}, ...]}; goal is null for rows without
/// one. Throws app::Failure(kCannotWrite).
void writeRows(const Rows& rows, const std::string& file);

} // namespace osgRayTrace::bench
