// PixelDecoder.h - converts an osg::Image of any common format to RGBA. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <osg/Image>

namespace osgRayTrace::engine
{

/// Sets size and pixels of the texture. Images of 8 bits or less a channel, compressed images and
/// images of 10 bits become bytes, others floats. Row 0 of the result is the row that OpenGL takes
/// as the lowest, the first in memory. Image::getOrigin() is a hint for file writers and for users
/// who set coordinates, and OSG ignores it when it uploads a texture. Missing channels are as in
/// OpenGL: alpha and luminance formats spread, GL_RED has no green and blue. A 3-D image gives its
/// first slice. Returns false and leaves the texture untouched for formats that cannot be read.
bool decodePixels(const osg::Image& image, Texture& texture);

} // namespace osgRayTrace::engine
