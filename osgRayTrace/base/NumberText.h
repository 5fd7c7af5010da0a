// NumberText.h - numbers from text, in any locale alike. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace osgRayTrace::engine
{

/// The number that all of the text is, with a point and a sign or none; "inf" and "nan" are numbers
/// of floating point. The process's locale, which may want a comma, has no part in it.
template <typename T> std::optional<T> parseNumber(std::string_view text)
{
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
    return value;
}

} // namespace osgRayTrace::engine
