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
    bool color = true; ///< false: alpha alone
    bool alpha = true;
};

/// Of the base format of OpenGL's internal format [OpenGL21, table 3.15 and 3.16]; of the image's
/// pixel format where the internal one is not known.
TextureChannels textureChannels(GLint internalFormat, GLenum pixelFormat);

/// The format in which OpenGL keeps the texture, as far as texture and image say so: the user's, or
/// the image's. 0 if neither says anything; image may be null. osg::Texture::getInternalFormat must
/// not be asked outside of a draw traversal: it asks context 0 which compressed formats there are,
/// and a context that is asked before it exists has none of OpenGL's functions from then on.
GLint internalFormatOf(const osg::Texture& texture, const osg::Image* image);

} // namespace osgRayTrace::engine
