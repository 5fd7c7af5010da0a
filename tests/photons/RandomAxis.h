// RandomAxis.h - directions along the axes: their products with lattice points are exact.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Statistics.h"

#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine::test
{

inline Vec3 axis(Uniform& uniform)
{
    const Vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    return axes[static_cast<int>(uniform() * 6.0f)];
}

} // namespace osgRayTrace::engine::test
