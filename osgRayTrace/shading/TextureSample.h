// TextureSample.h - looks a colour up in a texture. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <array>

namespace osgRayTrace::engine
{

/// Returns RGBA at uv (the unit square is the image once, v upwards), filtered and wrapped as the
/// texture says and decoded to linear if it asks for that. Any uv is accepted; a uv that is not
/// finite gives the corner texel.
Vec4 sampleTexture(const Texture& texture, Vec2 uv);

/// Returns RGBA at (s, t, r, q): of a cube map in the direction (s, t, r), of a 3-D image at (s, t,
/// r)/q, else at (s, t)/q.
Vec4 sampleTexture(const Texture& texture, Vec4 coordinates);

/// Tells which mips of a texture a look-up reads.
struct MipChoice
{
    int level = 0;      ///< 0: the image itself, else mips[level - 1]
    float share = 0.0f; ///< share of the next level
};

/// Returns the mips for a square footprint of this width [texture coordinates]: texels of their
/// level are as large as the footprint, by area [OpenGL21, eq. 3.18]. The image itself is taken for
/// a width of 0 and for textures without mips.
MipChoice mipFor(const Texture& texture, float width);

/// Returns the image of a level.
inline const Texture& levelOf(const Texture& texture, int level)
{
    return level == 0 ? texture : texture.mips[static_cast<std::size_t>(level - 1)];
}

/// Returns RGBA at uv as sampleTexture without a width does, but of the mips for the width.
Vec4 sampleTexture(const Texture& texture, Vec2 uv, float width);

/// Returns RGBA at (s, t, r, q) as sampleTexture without a width does, but of the mips for the
/// width.
Vec4 sampleTexture(const Texture& texture, Vec4 coordinates, float width);

/// Returns an upper bound of what look-ups give in red, green and blue, at least 0. Looks at all
/// texels, as far as none is the largest possible.
Vec3 largestTexel(const Texture& texture);

/// Returns a value, not below 0, that no look-up of a channel is below, 0: red to 3: alpha.
float leastTexel(const Texture& texture, int channel);

/// Returns the linear value of each sRGB byte [IEC61966].
const std::array<float, 256>& decodedBytes();

} // namespace osgRayTrace::engine
