// TenScenes.h - scenes that together have every kind of surface, light and placement.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

#include <string>

namespace osgRayTrace::engine::test
{

struct ComparedScene
{
    std::string name;
    std::shared_ptr<const TracedScene> traced;
    View view;
    bool mirrors = false; ///< smooth surfaces reflect others in WHITTED's direct light
    double size = 4.0;    ///< of the room [length]
};

std::vector<ComparedScene> tenScenes(int width, int height);

} // namespace osgRayTrace::engine::test
