// BlockDecoder.h - block-compressed images: DXT1, DXT3, DXT5 and RGTC. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Fills the pixels of the texture, not its size: bytes, but floats for the signed formats of RGTC.
/// Red and red-green formats have no blue [ARBrgtc]. False, and the texture untouched, for other
/// formats and for images with too little data.
bool decodeBlocks(const osg::Image& image, Texture& texture);

} // namespace osgRayTrace::engine
