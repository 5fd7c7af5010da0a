// TextureLanes.h - looks the colours of sixteen places up in one texture. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// Sets the lanes of color to the texture's colours at (s, t), as sampleTexture gives them but for
/// rounding. The texture is a 2-D image.
void textureColors(const Texture& texture, const FloatLanes& s, const FloatLanes& t, LaneMask lanes,
                   Vec3Lanes& color);

/// Sets the lanes of color to the texture's colours for footprints of these widths, as
/// sampleTexture gives them but for rounding.
void textureColors(const Texture& texture, const FloatLanes& s, const FloatLanes& t,
                   const FloatLanes& widths, LaneMask lanes, Vec3Lanes& color);

} // namespace osgRayTrace::engine
