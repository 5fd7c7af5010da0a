// DerivedTextures.cpp - reads channels of textures and writes them into images. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/DerivedTextures.h"

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/bridge/appearance/textures/TextureDecoder.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace osgRayTrace::engine
{

namespace
{

constexpr GLint kSrgb8Alpha8 = 0x8C43; // GL_SRGB8_ALPHA8

/// Returns the texels of a texture; nothing if they cannot be read.
std::optional<Texture> texelsOf(const osg::Texture2D& texture)
{
    const osg::Image* image = texture.getImage();
    Texture texels;
    if (!image || !image->data() || isTooLarge(*image, 1) || !decodeTexture(texture, texels))
        return std::nullopt;
    return texels;
}

/// Returns the nearest texel to the middle of a pixel of an image of another size.
float valueAt(const Texture& texels, int channel, int x, int y, int width, int height)
{
    const auto column = static_cast<std::size_t>(int64_t(x) * texels.width / width);
    const auto row = static_cast<std::size_t>(int64_t(y) * texels.height / height);
    const std::size_t at = 4 * (row * static_cast<std::size_t>(texels.width) + column) +
                           static_cast<std::size_t>(channel);
    return texels.bytes.empty() ? texels.floats[at] : float(texels.bytes[at]) / 255.0f;
}

osg::ref_ptr<osg::Image> imageOf(const std::array<ChannelSource, 3>& channels,
                                 const std::array<std::optional<Texture>, 3>& texels)
{
    int width = 1, height = 1;
    for (const std::optional<Texture>& source : texels)
        if (source)
        {
            width = std::max(width, source->width);
            height = std::max(height, source->height);
        }
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    if (!image->data()) return nullptr;
    for (int y = 0; y < height; ++y)
    {
        unsigned char* pixel = image->data(0, static_cast<unsigned int>(y));
        for (int x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
            {
                const float read =
                    texels[c] ? valueAt(*texels[c], channels[c].channel, x, y, width, height)
                              : 1.0f;
                const float value = texels[c] && channels[c].invert ? 1.0f - read : read;
                *pixel++ = static_cast<unsigned char>(std::clamp(value, 0.0f, 1.0f) * 255.0f +
                                                      0.5f); // NaN becomes 0
            }
    }
    return image;
}

void copySampling(const osg::Texture& from, osg::Texture2D& to)
{
    for (const auto direction : {osg::Texture::WRAP_S, osg::Texture::WRAP_T})
        to.setWrap(direction, from.getWrap(direction));
    for (const auto filter : {osg::Texture::MIN_FILTER, osg::Texture::MAG_FILTER})
        to.setFilter(filter, from.getFilter(filter));
    to.setBorderColor(from.getBorderColor());
    to.setName(from.getName());
}

/// Returns the texels as floats, which nobody decodes.
osg::ref_ptr<osg::Image> floatsOf(const osg::Texture2D& texture)
{
    const std::optional<Texture> texels = texelsOf(texture);
    if (!texels) return nullptr;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(texels->width, texels->height, 1, GL_RGBA, GL_FLOAT);
    if (!image->data()) return nullptr;
    auto* value = reinterpret_cast<float*>(image->data());
    for (int y = 0; y < texels->height; ++y)
        for (int x = 0; x < texels->width; ++x)
            for (int c = 0; c < 4; ++c)
                *value++ = valueAt(*texels, c, x, y, texels->width, texels->height);
    return image;
}

} // namespace

/// Returns the derived texture of a key, sampled as the first source is. make(texture) gives it its
/// image, and false if a source cannot be read. An image that was given up after it went to OpenGL
/// counts as unchanged.
template <class Make>
osg::Texture2D* DerivedTextures::find(const Key& key,
                                      const std::vector<const osg::Texture2D*>& sources,
                                      const Make& make)
{
    std::vector<Signature> now;
    bool hasImages = true;
    for (const osg::Texture2D* source : sources)
    {
        const osg::Image* image = source->getImage();
        hasImages = hasImages && image && image->data();
        now.push_back({source, image, image ? image->getModifiedCount() : 0});
    }
    const auto [found, isNew] = _entries.try_emplace(key);
    Entry& entry = found->second;
    entry.used = _round;
    const bool keeps = !isNew && (entry.sources == now || (entry.derived && !hasImages));
    if (!keeps)
    {
        entry.sources = std::move(now);
        if (!entry.derived) entry.derived = new osg::Texture2D;
        if (!make(*entry.derived)) entry.derived = nullptr;
    }
    if (entry.derived && !sources.empty()) copySampling(*sources.front(), *entry.derived);
    return entry.derived.get();
}

osg::Texture2D* DerivedTextures::ofChannels(const std::array<ChannelSource, 3>& channels)
{
    Key key{0, {channels[0].key(), channels[1].key(), channels[2].key()}};
    std::vector<const osg::Texture2D*> sources;
    for (const ChannelSource& source : channels)
        if (source.texture) sources.push_back(source.texture);
    return find(key, sources,
                [&](osg::Texture2D& derived)
                {
                    std::array<std::optional<Texture>, 3> texels;
                    for (std::size_t c = 0; c < 3; ++c)
                    {
                        if (!channels[c].texture) continue;
                        texels[c] = texelsOf(*channels[c].texture);
                        if (!texels[c]) return false;
                    }
                    const osg::ref_ptr<osg::Image> image = imageOf(channels, texels);
                    if (!image) return false;
                    derived.setImage(image);
                    return true;
                });
}

osg::Texture2D* DerivedTextures::ofEncoding(const osg::Texture2D& texture, bool srgb)
{
    return find(Key{srgb ? 2 : 1, {ChannelSource{&texture, 0, false}.key()}}, {&texture},
                [&](osg::Texture2D& derived)
                {
                    const osg::ref_ptr<osg::Image> floats = srgb ? nullptr : floatsOf(texture);
                    if (!srgb && !floats) return false;
                    // The image is held, but not changed.
                    derived.setImage(srgb ? const_cast<osg::Image*>(texture.getImage())
                                          : floats.get());
                    if (srgb) derived.setInternalFormat(kSrgb8Alpha8);
                    return !srgb || texture.getImage();
                });
}

osg::Texture2D* DerivedTextures::ofLayer(const osg::Texture2DArray& array, unsigned int layer)
{
    Layer& entry = _layers[{&array, layer}];
    entry.used = _round;
    entry.array = &array;
    const osg::Image* image = layer < array.getNumImages() ? array.getImage(layer) : nullptr;
    // An image that was given up after it went to OpenGL stays.
    if (!entry.texture && !image) return nullptr;
    if (!entry.texture) entry.texture = new osg::Texture2D;
    if (image && image != entry.texture->getImage())
        entry.texture->setImage(const_cast<osg::Image*>(image)); // held, but not changed
    if (array.getInternalFormatMode() == osg::Texture::USE_USER_DEFINED_FORMAT)
        entry.texture->setInternalFormat(array.getInternalFormat());
    copySampling(array, *entry.texture);
    return entry.texture.get();
}

void DerivedTextures::end()
{
    for (auto layer = _layers.begin(); layer != _layers.end();)
        layer = layer->second.used != _round ? _layers.erase(layer) : std::next(layer);
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.used != _round ? _entries.erase(entry) : std::next(entry);
}

} // namespace osgRayTrace::engine
