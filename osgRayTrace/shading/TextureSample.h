// TextureSample.h - looks a colour up in a texture. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// Returns RGBA at uv (the unit square is the image once, v upwards), filtered and wrapped as the
/// texture says and decoded to linear if it asks for that. Any uv is accepted; a uv that is not
/// finite gives the corner texel.
Vec4 sampleTexture(const Texture& texture, Vec2 uv);

/// Returns RGBA at (s, t, r, q): of a cube map in the direction (s, t, r), of a 3-D image at (s, t,
/// r)/q, else at (s, t)/q.
Vec4 sampleTexture(const Texture& texture, Vec4 coordinates);

} // namespace osgRayTrace::engine
