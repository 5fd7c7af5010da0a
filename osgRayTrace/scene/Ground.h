// Ground.h - a plane that is seen by the shadows on it alone. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine
{

/// The height of a ground that is not there.
constexpr float kNoGround = -kInfinity;

/// Returns whether there is a ground at this height.
inline bool hasGround(float height)
{
    return height > kNoGround;
}

} // namespace osgRayTrace::engine
