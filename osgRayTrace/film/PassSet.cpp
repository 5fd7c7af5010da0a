// PassSet.cpp - ranges of passes, in order and apart. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/PassSet.h"

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/base/NumberText.h"

#include <algorithm>

namespace osgRayTrace::engine
{

void PassSet::add(Range range)
{
    if (range.first >= range.second) return;
    const auto after = std::lower_bound(_ranges.begin(), _ranges.end(), range);
    const auto place = _ranges.insert(after, range);
    const auto index = static_cast<std::size_t>(place - _ranges.begin());
    OSGRAYTRACE_ASSERT(index == 0 || _ranges[index - 1].second <= range.first);
    OSGRAYTRACE_ASSERT(index + 1 == _ranges.size() || _ranges[index + 1].first >= range.second);
    const auto joinNext = [this](std::size_t i)
    {
        if (i + 1 >= _ranges.size() || _ranges[i].second != _ranges[i + 1].first) return;
        _ranges[i].second = _ranges[i + 1].second;
        _ranges.erase(_ranges.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    };
    joinNext(index);
    if (index > 0) joinNext(index - 1);
}

void PassSet::add(const PassSet& other)
{
    for (const Range& range : other._ranges)
        add(range);
}

int PassSet::firstMissing(int from) const
{
    for (const Range& range : _ranges)
        if (range.first <= from && from < range.second) return range.second;
    return from;
}

int PassSet::count(int half) const
{
    // Of the passes below n, (n + 1) / 2 are even and n / 2 are odd.
    const auto below = [half](int n) { return (n + 1 - half) / 2; };
    int passes = 0;
    for (const Range& range : _ranges)
        passes += below(range.second) - below(range.first);
    return passes;
}

std::optional<int> PassSet::firstCommon(const PassSet& other) const
{
    std::optional<int> common;
    for (const Range& a : _ranges)
        for (const Range& b : other._ranges)
        {
            const int first = std::max(a.first, b.first);
            if (first < std::min(a.second, b.second) && (!common || first < *common))
                common = first;
        }
    return common;
}

std::string passText(const PassSet& passes)
{
    std::string text;
    for (const auto& [first, end] : passes.ranges())
    {
        if (!text.empty()) text += ',';
        text += std::to_string(first);
        if (end - first > 1) text += '-' + std::to_string(end - 1);
    }
    return text;
}

std::optional<PassSet> passSetOf(const std::string& text)
{
    constexpr int kMostPasses = 1 << 30;
    constexpr std::size_t kLongest = std::size_t(1) << 16;
    if (text.size() > kLongest) return std::nullopt;
    PassSet passes;
    int least = 0; // the first pass that the next range may have
    for (std::size_t begin = 0; begin < text.size();)
    {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const std::string range = text.substr(begin, comma - begin);
        const std::size_t dash = range.find('-');
        const auto first = parseNumber<int>(range.substr(0, dash));
        const auto last =
            dash == std::string::npos ? first : parseNumber<int>(range.substr(dash + 1));
        if (!first || !last || *first < least || *last < *first || *last >= kMostPasses)
            return std::nullopt;
        passes.add({*first, *last + 1});
        least = *last + 1;
        begin = comma + 1;
        if (comma + 1 == text.size()) return std::nullopt; // the text ends with a comma
    }
    return passes;
}

} // namespace osgRayTrace::engine
