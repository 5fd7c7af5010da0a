// FormerOptions.h - earlier names of options, which are still read. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace osgRayTrace
{

struct FormerOption
{
    std::string_view name;
    std::string_view formerName;
};

constexpr FormerOption kFormerOptions[] = {
    {"photon-guiding", "aim-at-views"},
};

/// Returns the earlier name of an option; empty if it never had another one.
constexpr std::string_view formerNameOf(std::string_view name)
{
    for (const FormerOption& option : kFormerOptions)
    {
        if (option.name == name) return option.formerName;
    }
    return {};
}

} // namespace osgRayTrace
