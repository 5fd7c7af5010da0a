// Background.h - the colour of the background as a scene has it. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osg/Vec4>

#include <cmath>

namespace osgRayTrace::engine
{

/// Returns Scene::background for a clear colour, which is a display value; what of it is not finite
/// is 0.
inline Vec4 backgroundOf(const osg::Vec4& clearColor, bool linear)
{
    Vec4 color(clearColor.r(), clearColor.g(), clearColor.b(), clearColor.a());
    for (int c = 0; c < 4; ++c)
        if (!std::isfinite(color[c])) color[c] = 0.0f;
    for (int c = 0; c < 3 && linear; ++c)
        color[c] = linearFromSrgb(color[c]);
    return color;
}

} // namespace osgRayTrace::engine
