// TextureFormats.cpp - the channels that OpenGL's texture formats have. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/TextureFormats.h"

#include <osg/Image>
#include <osg/Texture>

#include <optional>

namespace osgRayTrace::engine
{

namespace
{

std::optional<TextureChannels> channelsOf(GLenum format)
{
    switch (format)
    {
    case GL_ALPHA:
    case GL_ALPHA4:
    case GL_ALPHA8:
    case GL_ALPHA12:
    case GL_ALPHA16:
    case GL_ALPHA16F_ARB:
    case GL_ALPHA32F_ARB:
        return TextureChannels{false, true};
    case 1:
    case 3:
    case GL_LUMINANCE:
    case GL_LUMINANCE4:
    case GL_LUMINANCE8:
    case GL_LUMINANCE12:
    case GL_LUMINANCE16:
    case GL_LUMINANCE16F_ARB:
    case GL_LUMINANCE32F_ARB:
    case GL_SLUMINANCE:
    case GL_SLUMINANCE8:
    case GL_DEPTH_COMPONENT:
    case GL_RED:
    case GL_R8:
    case GL_R16:
    case GL_R16F:
    case GL_R32F:
    case GL_RG:
    case GL_RG8:
    case GL_RG16:
    case GL_RG16F:
    case GL_RG32F:
    case GL_RGB:
    case GL_BGR:
    case GL_R3_G3_B2:
    case GL_RGB4:
    case GL_RGB5:
    case GL_RGB8:
    case GL_RGB10:
    case GL_RGB12:
    case GL_RGB16:
    case GL_RGB16F_ARB:
    case GL_RGB32F_ARB:
    case GL_SRGB:
    case GL_SRGB8:
    case GL_COMPRESSED_RGB:
    case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
    case GL_COMPRESSED_RED_RGTC1_EXT:
    case GL_COMPRESSED_SIGNED_RED_RGTC1_EXT:
    case GL_COMPRESSED_RED_GREEN_RGTC2_EXT:
    case GL_COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT:
        return TextureChannels{true, false};
    case 2:
    case 4:
    case GL_LUMINANCE_ALPHA:
    case GL_LUMINANCE8_ALPHA8:
    case GL_INTENSITY:
    case GL_INTENSITY8:
    case GL_RGBA:
    case GL_BGRA:
    case GL_RGBA4:
    case GL_RGB5_A1:
    case GL_RGBA8:
    case GL_RGB10_A2:
    case GL_RGBA16:
    case GL_RGBA16F_ARB:
    case GL_RGBA32F_ARB:
    case GL_SRGB_ALPHA:
    case GL_SRGB8_ALPHA8:
    case GL_COMPRESSED_RGBA:
    case GL_COMPRESSED_RGBA_S3TC_DXT1_EXT:
    case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
    case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT:
        return TextureChannels{true, true};
    default:
        return std::nullopt;
    }
}

} // namespace

TextureChannels textureChannels(GLint internalFormat, GLenum pixelFormat)
{
    if (const auto known = channelsOf(static_cast<GLenum>(internalFormat))) return *known;
    return channelsOf(pixelFormat).value_or(TextureChannels());
}

GLint internalFormatOf(const osg::Texture& texture, const osg::Image* image)
{
    const osg::Texture::InternalFormatMode mode = texture.getInternalFormatMode();
    // Only in this mode getInternalFormat computes nothing.
    const GLint users =
        mode == osg::Texture::USE_USER_DEFINED_FORMAT ? texture.getInternalFormat() : 0;
    if (users != 0 || !image) return users;
    const GLint format = image->getInternalTextureFormat();
    // This is the one compression that keeps less than the image has.
    const bool losesAlpha = mode == osg::Texture::USE_S3TC_DXT1c_COMPRESSION &&
                            (image->getPixelFormat() == GL_RGBA || image->getPixelFormat() == 4);
    return losesAlpha ? GL_COMPRESSED_RGB_S3TC_DXT1_EXT : format;
}

} // namespace osgRayTrace::engine
