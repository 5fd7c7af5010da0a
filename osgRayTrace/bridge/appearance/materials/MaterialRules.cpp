// MaterialRules.cpp - which rule of a material file a name gets. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"

#include <utility>

namespace osgRayTrace::engine
{

bool matchesPattern(const std::string& pattern, const std::string& name)
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

MaterialRule* MaterialRuleList::add(MaterialRule rule)
{
    if (!_byName.try_emplace(rule.pattern, _rules.size()).second) return nullptr;
    if (rule.pattern.find('*') != std::string::npos) _patterns.push_back(_rules.size());
    return &_rules.emplace_back(std::move(rule));
}

const MaterialRule* MaterialRuleList::find(const std::string& name) const
{
    if (name.empty() || _rules.empty()) return nullptr;
    if (const auto named = _byName.find(name); named != _byName.end())
        return &_rules[named->second];
    for (const std::size_t pattern : _patterns)
        if (matchesPattern(_rules[pattern].pattern, name)) return &_rules[pattern];
    return nullptr;
}

} // namespace osgRayTrace::engine
