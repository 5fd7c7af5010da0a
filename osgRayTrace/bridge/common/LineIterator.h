// LineIterator.h - characters of a text, and the line that a parser has come to. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <iterator>

namespace osgRayTrace::engine
{

/// Counts the lines that a parser has read.
struct LineIterator
{
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    reference operator*() const { return *at; }
    LineIterator& operator++()
    {
        if (*at == '\n') ++*line;
        ++at;
        return *this;
    }
    bool operator==(const LineIterator& other) const { return at == other.at; }
    bool operator!=(const LineIterator& other) const { return at != other.at; }

    const char* at;
    int* line;
};

} // namespace osgRayTrace::engine
