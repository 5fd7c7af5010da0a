// StoredSettings.cpp - settings that a scene brings with it, and those of the command line. Layer:
// apps.
// SPDX-License-Identifier: MIT
#include "Options.h"

#include <algorithm>

namespace osgRayTrace::app
{

void takeStoredSettings(const RayTraceSettings& stored, Options& options)
{
    options.settings = new RayTraceSettings(stored);
    const auto known = RayTraceSettings::options();
    const auto limit = std::find_if(known.begin(), known.end(),
                                    [](const auto& option) { return option.name == "max-passes"; });
    if (options.defaultPasses && stored.get(limit->name) == limit->defaultValue)
        options.settings->setMaxPasses(*options.defaultPasses);
    for (const auto& [name, value] : options.assignments)
        options.settings->set(name, value);
}

} // namespace osgRayTrace::app
