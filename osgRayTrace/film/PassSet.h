// PassSet.h - a set of pass numbers, as an image has them. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds numbers of passes, each once. Images that are traced in parts, on several machines or with
/// interruptions, have sets with holes.
class PassSet
{
public:
    /// The passes from first to end, end excluded.
    using Range = std::pair<int, int>;

    PassSet() = default;
    explicit PassSet(int passes) { add({0, passes}); } ///< 0, 1, ... passes - 1

    /// Adds passes that are not in the set.
    void add(Range range);
    void add(int pass) { add({pass, pass + 1}); }
    void add(const PassSet& other);

    bool contains(int pass) const { return firstMissing(pass) != pass; }
    bool empty() const { return _ranges.empty(); }

    /// Returns the first pass from this one on that is not in the set.
    int firstMissing(int from) const;

    /// Returns the number of passes of a half of the image: 0 has the even passes, 1 the odd ones.
    int count(int half) const;
    int count() const { return count(0) + count(1); }

    /// Returns the least pass that both sets have; nothing if they have none in common.
    std::optional<int> firstCommon(const PassSet& other) const;

    /// Returns the ranges in order, with holes between them.
    const std::vector<Range>& ranges() const { return _ranges; }

    bool operator==(const PassSet& other) const { return _ranges == other._ranges; }
    bool operator!=(const PassSet& other) const { return !(*this == other); }

private:
    std::vector<Range> _ranges;
};

/// Returns the set as text, with the last pass of each range: "0-127,136-143,150"; empty for none.
std::string passText(const PassSet& passes);

/// Returns the set that a text of passText() stands for; nothing for other texts.
std::optional<PassSet> passSetOf(const std::string& text);

} // namespace osgRayTrace::engine
