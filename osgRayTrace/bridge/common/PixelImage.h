// PixelImage.h - the engine's pixels as osg::Image. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Vec4>

#include <vector>

namespace osgRayTrace::engine
{

/// Returns an image whose rows have no padding and whose pixels are not initialised. Returns null,
/// with a warning, if the image has more than the 4 GiB that osg::Image can count. Throws
/// std::bad_alloc.
osg::ref_ptr<osg::Image> newPixelImage(int width, int height, GLenum format, GLenum type);

/// Returns a GL_FLOAT image of the values, which are width * height times the format's components.
/// Null and exceptions are as for newPixelImage.
osg::ref_ptr<osg::Image> pixelImage(const std::vector<float>& values, int width, int height,
                                    GLenum format);

/// Blends premultiplied GL_RGBA, GL_UNSIGNED_BYTE pixels over one colour in [0,1], to the value
/// nearest to the result of OpenGL's (GL_ONE, GL_ONE_MINUS_SRC_ALPHA) in a frame buffer of 8 bits.
void blendOver(osg::Image& image, const osg::Vec4& color);

/// Does the same over opaque pixels of a background of the same size and format, both without
/// padding.
void blendOver(osg::Image& image, const osg::Image& background);

} // namespace osgRayTrace::engine
