// TextureFormats.h - the channels that OpenGL's texture formats have. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/GL>

namespace osg
{
class Image;
class Texture;
} // namespace osg

namespace osgRayTrace::engine
{

struct TextureChannels
{
    bool color = true; ///< false: the format has alpha alone
    bool alpha = true;
};

/// Returns the channels of the base format of OpenGL's internal format [OpenGL21, table 3.15 and
/// 3.16]; those of the image's pixel format if the internal format is not known.
TextureChannels textureChannels(GLint internalFormat, GLenum pixelFormat);

/// Returns the format in which OpenGL keeps the texture, as far as texture and image tell: the
/// user's format, or the image's; 0 if neither tells. image may be null.
/// osg::Texture::getInternalFormat must not be called outside of a draw traversal. The function
/// asks context 0 for the compressed formats; a context that is asked before it exists has none of
/// OpenGL's functions from then on.
GLint internalFormatOf(const osg::Texture& texture, const osg::Image* image);

} // namespace osgRayTrace::engine
