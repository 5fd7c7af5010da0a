// PixelDecoder.h - from an osg::Image of any common format to RGBA. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Fills size and pixels of the texture: images of 8 bits or less a channel, and compressed ones,
/// as bytes, others as floats (10 bits as bytes). Row 0 of the result is the row that OpenGL takes
/// as the lowest, the first in memory: Image::getOrigin() is a hint for file writers and users who
/// set coordinates, and OSG does not look at it when it uploads a texture. Missing channels as in
/// OpenGL: alpha and luminance formats spread, GL_RED has no green and blue. Of a 3-D image the
/// first slice. False, and the texture untouched, for formats that cannot be read.
bool decodePixels(const osg::Image& image, Texture& texture);

} // namespace osgRayTrace::engine
