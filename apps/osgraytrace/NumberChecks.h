// NumberChecks.h - which numbers the command line takes. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/NumberText.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace osgRayTrace::app
{

/// Returns a validator for numbers within (low, high), low and high themselves excluded.
inline CLI::Validator between(double low, double high, const std::string& wanted)
{
    const auto problem = [=](const std::string& text)
    {
        const auto value = engine::parseNumber<double>(text);
        const bool good = value && *value > low && *value < high;
        return good ? std::string() : "'" + text + "' is not " + wanted;
    };
    return CLI::Validator(problem, "");
}

inline CLI::Validator finite()
{
    return between(-HUGE_VAL, HUGE_VAL, "a finite number");
}

inline CLI::Validator positive()
{
    return between(0.0, HUGE_VAL, "a number above 0");
}

} // namespace osgRayTrace::app
