// MaterialParameters.h - the parameters that a material file may give. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PhysicalMaterial>

#include <cstddef>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

using Values = std::vector<double>;

/// Describes one parameter: a number, or three for a colour.
struct Parameter
{
    const char* name;
    std::size_t count;
    double lowest, highest;
    void (*set)(PhysicalMaterial&, const Values&);
    Values (*get)(const PhysicalMaterial&) = nullptr;
    bool isWhole = false; ///< true: a file with a fraction is refused
};

/// Returns the parameter of a name; null if there is none.
const Parameter* findParameter(const std::string& name);

/// Returns all parameters, in the order of the documentation.
const std::vector<const Parameter*>& allParameters();

/// Returns all names, separated by commas.
std::string parameterNames();

} // namespace osgRayTrace::engine
