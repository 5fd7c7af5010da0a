// MaterialValues.h - compares materials by all that can be seen of them. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns the values that decide on the picture, bit by bit, which are equal for materials that
/// can be merged. Name and stamp are left out.
std::vector<uint32_t> materialValues(const Material& material);

/// Returns whether two materials are equal in all that affects the picture.
inline bool sameMaterial(const Material& a, const Material& b)
{
    return materialValues(a) == materialValues(b);
}

/// Returns the colours of the material's front face, which are those of both faces if the back has
/// no others.
inline FaceColors frontOf(const Material& m)
{
    return {m.ambient, m.diffuse, m.specular, m.emission, m.shininess, m.alpha};
}

} // namespace osgRayTrace::engine
