// TextureFormats.cpp - the channels that OpenGL's texture formats have. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/TextureFormats.h"

#include <osg/Image>
#include <osg/Texture>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

namespace osgRayTrace::engine
{

namespace
{

constexpr GLenum kAlphaFormats[] = {GL_ALPHA,   GL_ALPHA4,       GL_ALPHA8,      GL_ALPHA12,
                                    GL_ALPHA16, GL_ALPHA16F_ARB, GL_ALPHA32F_ARB};

constexpr GLenum kColorFormats[] = {1,
                                    3,
                                    GL_LUMINANCE,
                                    GL_LUMINANCE4,
                                    GL_LUMINANCE8,
                                    GL_LUMINANCE12,
                                    GL_LUMINANCE16,
                                    GL_LUMINANCE16F_ARB,
                                    GL_LUMINANCE32F_ARB,
                                    GL_SLUMINANCE,
                                    GL_SLUMINANCE8,
                                    GL_DEPTH_COMPONENT,
                                    GL_RED,
                                    GL_R8,
                                    GL_R16,
                                    GL_R16F,
                                    GL_R32F,
                                    GL_RG,
                                    GL_RG8,
                                    GL_RG16,
                                    GL_RG16F,
                                    GL_RG32F,
                                    GL_RGB,
                                    GL_BGR,
                                    GL_R3_G3_B2,
                                    GL_RGB4,
                                    GL_RGB5,
                                    GL_RGB8,
                                    GL_RGB10,
                                    GL_RGB12,
                                    GL_RGB16,
                                    GL_RGB16F_ARB,
                                    GL_RGB32F_ARB,
                                    GL_SRGB,
                                    GL_SRGB8,
                                    GL_COMPRESSED_RGB,
                                    GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
                                    GL_COMPRESSED_RED_RGTC1_EXT,
                                    GL_COMPRESSED_SIGNED_RED_RGTC1_EXT,
                                    GL_COMPRESSED_RED_GREEN_RGTC2_EXT,
                                    GL_COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT};

constexpr GLenum kColorAndAlphaFormats[] = {2,
                                            4,
                                            GL_LUMINANCE_ALPHA,
                                            GL_LUMINANCE8_ALPHA8,
                                            GL_INTENSITY,
                                            GL_INTENSITY8,
                                            GL_RGBA,
                                            GL_BGRA,
                                            GL_RGBA4,
                                            GL_RGB5_A1,
                                            GL_RGBA8,
                                            GL_RGB10_A2,
                                            GL_RGBA16,
                                            GL_RGBA16F_ARB,
                                            GL_RGBA32F_ARB,
                                            GL_SRGB_ALPHA,
                                            GL_SRGB8_ALPHA8,
                                            GL_COMPRESSED_RGBA,
                                            GL_COMPRESSED_RGBA_S3TC_DXT1_EXT,
                                            GL_COMPRESSED_RGBA_S3TC_DXT3_EXT,
                                            GL_COMPRESSED_RGBA_S3TC_DXT5_EXT};

template <std::size_t N> bool isIn(const GLenum (&formats)[N], GLenum format)
{
    return std::find(std::begin(formats), std::end(formats), format) != std::end(formats);
}

std::optional<TextureChannels> channelsOf(GLenum format)
{
    if (isIn(kAlphaFormats, format)) return TextureChannels{false, true};
    if (isIn(kColorFormats, format)) return TextureChannels{true, false};
    if (isIn(kColorAndAlphaFormats, format)) return TextureChannels{true, true};
    return std::nullopt;
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
