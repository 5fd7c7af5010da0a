// Bodies.h - which materials enclose bodies. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// Returns whether the surfaces of a material enclose bodies that light can enter.
inline bool enclosesBody(const Material& m)
{
    if (m.model != MaterialModel::Physical || isMetal(m) || isInvisible(m)) return false;
    if (m.detail && m.detail->thinWalled) return false;
    return m.transmission > 0.0f || (m.detail && m.detail->diffuseTransmission > 0.0f);
}

} // namespace osgRayTrace::engine
