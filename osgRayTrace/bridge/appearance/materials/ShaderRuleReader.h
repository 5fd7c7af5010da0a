// ShaderRuleReader.h - reads a rule of the group "shaders" of a material file. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/LocatedJson.h"
#include "osgRayTrace/bridge/appearance/materials/ShaderRule.h"

#include <string>

namespace osgRayTrace::engine
{

struct ShaderRuleResult
{
    ShaderRule rule;
    std::string error; ///< empty: none
    int line = 0;      ///< line of the error
};

/// Reads a rule. number counts rules from 1, for the name of a rule that has none.
ShaderRuleResult readShaderRule(const LocatedJson& json, std::size_t number);

} // namespace osgRayTrace::engine
