// NamePattern.h - names with "*", which stands for any characters. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::engine
{

/// Returns whether replacing each '*' in pattern by some characters can give the name.
inline bool matchesPattern(const std::string& pattern, const std::string& name)
{
    // The search is greedy with one point to return to: the last star can always take more.
    std::size_t p = 0, n = 0, star = std::string::npos, taken = 0;
    while (n < name.size())
    {
        if (p < pattern.size() && pattern[p] == '*')
        {
            star = p++;
            taken = n;
        }
        else if (p < pattern.size() && pattern[p] == name[n])
        {
            ++p;
            ++n;
        }
        else if (star != std::string::npos)
        {
            p = star + 1;
            n = ++taken;
        }
        else
            return false;
    }
    return pattern.find_first_not_of('*', p) == std::string::npos;
}

} // namespace osgRayTrace::engine
