// TextureMips.h - smaller images of a texture, for look-ups with a footprint. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// Returns the mips of a 2-D image: each half as wide and high as the one before, rounded down, but
/// at least 1, down to one texel. A texel is the mean of the part of the image that it covers, also
/// if sizes are odd. Means are those of linear values; each level is made of the values of the one
/// before, not of its bytes. All mips together have at most a third as many texels as the image,
/// or as many for an image of one row. linearFilter is the filter of the mips.
std::vector<Texture> textureMips(const Texture& image, bool linearFilter);

} // namespace osgRayTrace::engine
