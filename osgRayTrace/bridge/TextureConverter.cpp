// TextureConverter.cpp - wrap and filter modes, and the cache of textures. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/TextureConverter.h"

#include "osgRayTrace/bridge/PixelDecoder.h"

namespace osgRayTrace::engine
{

namespace
{

TextureWrap wrapOf(const osg::Texture& texture, osg::Texture::WrapParameter direction)
{
    switch (texture.getWrap(direction))
    {
    case osg::Texture::REPEAT:
        return TextureWrap::Repeat;
    case osg::Texture::MIRROR:
        return TextureWrap::Mirror;
    default:
        return TextureWrap::ClampToEdge;
    }
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
    return mode == osg::Texture::NEAREST;
}

std::string nameOf(const osg::Texture2D& texture, const osg::Image& image)
{
    if (!texture.getName().empty()) return texture.getName();
    return image.getFileName().empty() ? image.getName() : image.getFileName();
}

/// More than the engine takes, or than osg::Image can address in the 32 bits of its offsets.
bool isTooLarge(const osg::Image& image)
{
    constexpr int64_t kMostTexels = int64_t(1) << 28, kMostBytes = (int64_t(1) << 32) - 1;
    return int64_t(image.s()) * image.t() > kMostTexels ||
           int64_t(image.getRowStepInBytes()) * image.t() > kMostBytes;
}

void fillMagenta(Texture& texture)
{
    texture.width = 1;
    texture.height = 1;
    texture.bytes = {255, 0, 255, 255};
}

} // namespace

void TextureConverter::begin(bool linear, Stamp stamp)
{
    _linear = linear;
    _stamp = stamp;
    _textures.clear();
    for (auto& [key, entry] : _entries)
        entry.index = kInvalid;
}

uint32_t TextureConverter::index(const osg::Texture2D* texture, TextureContent content,
                                 ConversionReport& report)
{
    if (!texture) return kInvalid;
    const bool color = content == TextureContent::Color;
    const bool decode = color && (_linear || isSrgbFormat(texture->getInternalFormat()));
    Entry& entry = _entries[{texture, decode}];
    if (entry.index != kInvalid && entry.texture.get() == texture) return entry.index;
    if (!isCurrent(entry, *texture))
    {
        entry = {};
        const osg::Image* image = texture->getImage();
        if (!image || !image->data())
        {
            report.count("approximated.texture-without-image");
            return kInvalid;
        }
        auto converted = std::make_shared<Texture>();
        converted->name = nameOf(*texture, *image);
        if (isTooLarge(*image))
        {
            report.warn("approximated.texture-size", "texture '" + converted->name + "'",
                        "more than 2^28 texels or 4 GiB, shown in magenta");
            fillMagenta(*converted);
        }
        else if (!decodePixels(*image, *converted))
        {
            report.warn("approximated.pixel-format", "texture '" + converted->name + "'",
                        "pixel format cannot be read, shown in magenta");
            fillMagenta(*converted);
        }
        converted->decodeSrgb = decode && !converted->bytes.empty();
        converted->linearFilter = !isNearest(texture->getFilter(osg::Texture::MAG_FILTER));
        converted->wrapS = wrapOf(*texture, osg::Texture::WRAP_S);
        converted->wrapT = wrapOf(*texture, osg::Texture::WRAP_T);
        converted->changed = _stamp;
        entry.texture = texture;
        entry.image = image;
        entry.imageModified = image->getModifiedCount();
        entry.imageData = image->data();
        entry.converted = std::move(converted);
    }
    entry.index = static_cast<uint32_t>(_textures.size());
    _textures.push_back(entry.converted);
    return entry.index;
}

/// Also true if the image was given up after it went to OpenGL (setUnRefImageDataAfterApply): what
/// was converted before stays.
bool TextureConverter::isCurrent(const Entry& entry, const osg::Texture2D& texture) const
{
    if (!entry.converted || entry.texture.get() != &texture) return false;
    const Texture& old = *entry.converted;
    if (old.linearFilter == isNearest(texture.getFilter(osg::Texture::MAG_FILTER)) ||
        old.wrapS != wrapOf(texture, osg::Texture::WRAP_S) ||
        old.wrapT != wrapOf(texture, osg::Texture::WRAP_T))
        return false;
    const osg::Image* image = texture.getImage();
    if (!image) return true;
    return entry.image.get() == image && entry.imageModified == image->getModifiedCount() &&
           entry.imageData == image->data();
}

std::vector<std::shared_ptr<const Texture>> TextureConverter::end()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.index == kInvalid ? _entries.erase(entry) : std::next(entry);
    return std::move(_textures);
}

} // namespace osgRayTrace::engine
