// PathStep.h - one step of a path in a CAVE configuration. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::app
{

/// Holds a step of a path: "Name" or "Name:suffix", which asks for name="suffix".
struct Step
{
    explicit Step(const std::string& text)
        : element(text.substr(0, text.find(':'))),
          hasName(element.size() < text.size()),
          name(hasName ? text.substr(element.size() + 1) : "")
    {
    }

    std::string element;
    bool hasName;
    std::string name;
};

} // namespace osgRayTrace::app
