// RuleCaches.h - what the rules of a material file have derived, kept between conversions. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/DerivedTextures.h"
#include "osgRayTrace/bridge/graph/VertexLayouts.h"

namespace osgRayTrace::engine
{

struct RuleCaches
{
    DerivedTextures textures;
    VertexLayouts layouts;

    void begin()
    {
        textures.begin();
        layouts.begin();
    }

    /// Forgets what nobody has asked for since begin().
    void end()
    {
        textures.end();
        layouts.end();
    }
};

} // namespace osgRayTrace::engine
