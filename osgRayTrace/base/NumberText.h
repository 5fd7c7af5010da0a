// NumberText.h - numbers as text and back, alike in any locale. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace osgRayTrace::engine
{

/// Returns the number that the whole text is; nothing if it is none. A number may have a decimal
/// point and a sign; "inf" and "nan" are floating-point numbers. The process's locale, which may
/// want a comma, has no influence.
template <typename T> std::optional<T> parseNumber(std::string_view text)
{
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    T value{};
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
    return value;
}

/// Returns the shortest text that parseNumber<T>() reads as the same number; "inf" and "nan" for
/// floating-point numbers that are not finite. The process's locale has no influence.
template <typename T> std::string numberText(T value)
{
    char digits[64];
    const auto result = std::to_chars(digits, digits + sizeof digits, value);
    return std::string(digits, result.ptr);
}

} // namespace osgRayTrace::engine
