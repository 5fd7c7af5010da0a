// Compare.h - counts the values in which two pictures differ. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

/// Returns the number of values that are not equal bit by bit, except for the sign of zero; NaN
/// differs from itself.
inline std::size_t differing(const Picture& a, const Picture& b)
{
    if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) return a.rgba.size() + b.rgba.size() + 1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        count += !(a.rgba[i] == b.rgba[i]);
    return count;
}

} // namespace osgRayTrace::engine::test
