// ImageLayout.h - how an osg::Image stores channels. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/exr/ExrImage.h"

#include <osg/Image>

#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Tells how an osg::Image stores the channels that a file has under these names.
struct ImageLayout
{
    GLenum pixelFormat;
    std::vector<std::string> channels;
    GLint floatTexture = 0; ///< internal format of float images; 0: reading never makes this layout
    GLint halfTexture = 0;  ///< internal format of half images; images of bytes have pixelFormat

    GLint internalFormat(GLenum type) const;
};

/// Returns the layout of a pixel format; without channels if the format is of no layout.
const ImageLayout& layoutOf(GLenum pixelFormat);

/// Returns the pixel format for the channels of an image; GL_NONE: none of them is of a colour.
GLenum formatOf(const ExrImage& image);

} // namespace osgRayTrace::engine
