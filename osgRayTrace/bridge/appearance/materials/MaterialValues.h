// MaterialValues.h - materials compared by what can be seen of them. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// The values that decide on the picture, bit by bit: equal for materials that can be merged. Name
/// and stamp are none of them.
std::vector<uint32_t> materialValues(const Material& material);

/// Equal in all that affects the picture.
inline bool sameMaterial(const Material& a, const Material& b)
{
    return materialValues(a) == materialValues(b);
}

/// The colours of its front face, or of both if it has no others on the back.
inline FaceColors frontOf(const Material& m)
{
    return {m.ambient, m.diffuse, m.specular, m.emission, m.shininess, m.alpha};
}

} // namespace osgRayTrace::engine
