// MaterialRules.cpp - which rule of a material file a name gets. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialLibrary.h"

#include <utility>

namespace osgRayTrace::engine
{

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
