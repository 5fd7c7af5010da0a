// TextureDecoder.cpp - decodes textures of all targets. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/TextureDecoder.h"

#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/bridge/appearance/textures/PixelDecoder.h"
#include "osgRayTrace/bridge/appearance/textures/TextureFormats.h"

#include <osg/Texture1D>
#include <osg/Texture2D>
#include <osg/Texture3D>
#include <osg/TextureCubeMap>
#include <osg/TextureRectangle>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

bool isCube(const osg::Texture& texture)
{
    return texture.getTextureTarget() == GL_TEXTURE_CUBE_MAP;
}

/// Puts the faces of a cube above each other. Returns false if the faces are not squares of one
/// size and kind.
bool decodeCube(const osg::Texture& source, Texture& texture)
{
    for (unsigned int face = 0; face < 6; ++face)
    {
        const osg::Image* image = source.getImage(face);
        Texture one;
        if (!image || !decodePixels(*image, one) || one.width != one.height) return false;
        if (face > 0 && (one.width != texture.width || one.bytes.empty() != texture.bytes.empty()))
            return false;
        texture.width = one.width;
        texture.bytes.insert(texture.bytes.end(), one.bytes.begin(), one.bytes.end());
        texture.floats.insert(texture.floats.end(), one.floats.begin(), one.floats.end());
    }
    texture.height = 6 * texture.width;
    texture.cube = true;
    return true;
}

/// Puts the slices of a 3-D image one after the other.
bool decodeVolume(const osg::Image& image, Texture& texture)
{
    if (image.isCompressed()) return false;
    for (int r = 0; r < image.r(); ++r)
    {
        // Refers to the image's memory, and is only read.
        const osg::ref_ptr<osg::Image> slice = new osg::Image;
        slice->setImage(image.s(), image.t(), 1, image.getInternalTextureFormat(),
                        image.getPixelFormat(), image.getDataType(),
                        const_cast<unsigned char*>(image.data(0, 0, r)), osg::Image::NO_DELETE,
                        static_cast<int>(image.getPacking()), image.getRowLength());
        Texture one;
        if (!decodePixels(*slice, one)) return false;
        texture.width = one.width;
        texture.height = one.height;
        texture.bytes.insert(texture.bytes.end(), one.bytes.begin(), one.bytes.end());
        texture.floats.insert(texture.floats.end(), one.floats.begin(), one.floats.end());
    }
    texture.depth = image.r();
    return texture.depth > 0;
}

} // namespace

TextureWrap wrapOf(const osg::Texture& texture, osg::Texture::WrapParameter direction)
{
    switch (texture.getWrap(direction))
    {
    case osg::Texture::REPEAT:
        return TextureWrap::Repeat;
    case osg::Texture::MIRROR:
        return TextureWrap::Mirror;
    case osg::Texture::CLAMP:
        return TextureWrap::Clamp;
    case osg::Texture::CLAMP_TO_BORDER:
        return TextureWrap::ClampToBorder;
    default:
        return TextureWrap::ClampToEdge;
    }
}

Vec4 borderOf(const osg::Texture& texture)
{
    const osg::Vec4d& color = texture.getBorderColor();
    Vec4 border(0.0f);
    for (int c = 0; c < 4; ++c)
        if (std::isfinite(color[c])) border[c] = static_cast<float>(std::clamp(color[c], 0.0, 1.0));
    return border;
}

bool isSrgbFormat(GLint internalFormat)
{
    switch (internalFormat)
    {
    case GL_SRGB:
    case GL_SRGB8:
    case GL_SRGB_ALPHA:
    case GL_SRGB8_ALPHA8:
        return true;
    default:
        return false;
    }
}

bool isNearest(osg::Texture::FilterMode mode)
{
    return mode == osg::Texture::NEAREST || mode == osg::Texture::NEAREST_MIPMAP_NEAREST ||
           mode == osg::Texture::NEAREST_MIPMAP_LINEAR;
}

bool wantsMips(const osg::Texture& texture)
{
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    return texture.getTextureTarget() == GL_TEXTURE_2D && filter != osg::Texture::NEAREST &&
           filter != osg::Texture::LINEAR;
}

bool blendsMips(osg::Texture::FilterMode minification)
{
    return minification == osg::Texture::LINEAR_MIPMAP_LINEAR ||
           minification == osg::Texture::NEAREST_MIPMAP_LINEAR;
}

bool isVolume(const osg::Texture& texture)
{
    return texture.getTextureTarget() == GL_TEXTURE_3D;
}

unsigned int imageCount(const osg::Texture& texture)
{
    return isCube(texture) ? 6u : 1u;
}

std::string nameOf(const osg::Texture& texture, const osg::Image& image)
{
    if (!texture.getName().empty()) return texture.getName();
    return image.getFileName().empty() ? image.getName() : image.getFileName();
}

bool isTooLarge(const osg::Image& image, int slices)
{
    constexpr int64_t kMostTexels = int64_t(1) << 28, kMostBytes = (int64_t(1) << 32) - 1;
    const int64_t rows = int64_t(image.t()) * slices;
    return image.s() > kMostTexels || rows > kMostTexels || image.s() * rows > kMostTexels ||
           int64_t(image.getRowStepInBytes()) > kMostBytes ||
           int64_t(image.getRowStepInBytes()) * rows > kMostBytes;
}

void fillMagenta(Texture& texture)
{
    texture.width = 1;
    texture.height = 1;
    texture.depth = 0;
    texture.cube = false;
    texture.floats.clear();
    texture.bytes = {255, 0, 255, 255};
}

void setChannels(GLint internalFormat, GLenum pixelFormat, Texture& texture)
{
    const TextureChannels channels = textureChannels(internalFormat, pixelFormat);
    texture.hasColor = channels.color;
    texture.hasAlpha = channels.alpha;
    const bool floats = !texture.floats.empty();
    const std::size_t count = floats ? texture.floats.size() : texture.bytes.size();
    texture.opaque = true;
    for (std::size_t i = 3; i < count; i += 4)
    {
        if (!channels.alpha)
            floats ? (void)(texture.floats[i] = 1.0f) : (void)(texture.bytes[i] = 255);
        else if (floats ? texture.floats[i] < 1.0f : texture.bytes[i] < 255)
            texture.opaque = false;
    }
}

bool decodeTexture(const osg::Texture& source, Texture& texture)
{
    if (isCube(source)) return decodeCube(source, texture);
    const osg::Image& image = *source.getImage(0);
    return isVolume(source) ? decodeVolume(image, texture) : decodePixels(image, texture);
}

} // namespace osgRayTrace::engine
