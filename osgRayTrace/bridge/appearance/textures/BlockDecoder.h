// BlockDecoder.h - decodes block-compressed images: DXT1, DXT3, DXT5 and RGTC. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Sets the pixels of the texture, but not its size. The pixels are bytes, except for floats in the
/// signed formats of RGTC. Red and red-green formats have no blue [ARBrgtc]. Returns false and
/// leaves the texture untouched for other formats and for images with too little data.
bool decodeBlocks(const osg::Image& image, Texture& texture);

} // namespace osgRayTrace::engine
