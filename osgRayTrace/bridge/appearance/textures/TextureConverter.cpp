// TextureConverter.cpp - converts targets, wrap and filter modes of textures. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"

#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/bridge/appearance/textures/MissingImages.h"
#include "osgRayTrace/bridge/appearance/textures/TextureDecoder.h"
#include "osgRayTrace/bridge/appearance/textures/TextureFormats.h"
#include "osgRayTrace/shading/TextureMips.h"

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

template <class T> bool isFilledByCallback(const osg::Texture& texture)
{
    const auto* filled = dynamic_cast<const T*>(&texture);
    return filled && filled->getSubloadCallback();
}

} // namespace

bool isOnlyInOpenGL(const osg::Texture& texture)
{
    if (isFilledByCallback<osg::Texture2D>(texture) ||
        isFilledByCallback<osg::Texture3D>(texture) ||
        isFilledByCallback<osg::TextureRectangle>(texture) ||
        isFilledByCallback<osg::TextureCubeMap>(texture) ||
        isFilledByCallback<osg::Texture1D>(texture))
        return true;
    const osg::Image* image = texture.getImage(0);
    return !(image && image->data()) && texture.getTextureWidth() > 0;
}

void TextureConverter::begin(bool linear, Stamp stamp)
{
    _linear = linear;
    _stamp = stamp;
    _textures.clear();
    _gaps.clear();
    for (auto& [key, entry] : _entries)
        entry.index = kInvalid;
}

uint32_t TextureConverter::index(const osg::Texture* texture, TextureContent content,
                                 ConversionReport& report)
{
    if (!texture) return kInvalid;
    const bool color = content == TextureContent::Color;
    const bool decode = color && (_linear || isSrgb(*texture));
    Entry& entry = _entries[{texture, decode}];
    const bool current =
        (entry.looked == _stamp && entry.texture.get() == texture) || isCurrent(entry, *texture);
    if (!current && !convert(entry, *texture, decode, report)) return kInvalid;
    entry.looked = _stamp;
    if (!entry.mips && content != TextureContent::Normals && wantsMips(*texture))
        addMips(entry, *texture, current);
    if (entry.index == kInvalid && !_gaps.empty())
    {
        entry.index = _gaps.back();
        _gaps.pop_back();
    }
    if (entry.index == kInvalid)
    {
        entry.index = static_cast<uint32_t>(_textures.size());
        _textures.push_back(entry.converted);
    }
    _textures[entry.index] = entry.converted;
    return entry.index;
}

/// Returns whether the texture is encoded in sRGB; also of an image given up, if its format tells.
bool TextureConverter::isSrgb(const osg::Texture& texture) const
{
    const osg::Image* image = texture.getImage(0);
    if (isSrgbFormat(internalFormatOf(texture, image))) return true;
    const auto known = image ? _entries.end() : _entries.find({&texture, true});
    return known != _entries.end() && known->second.texture.get() == &texture &&
           isSrgbFormat(known->second.internalFormat);
}

/// Converts the texture again; the entry keeps its index. Returns false if it has no texels.
bool TextureConverter::convert(Entry& entry, const osg::Texture& texture, bool decode,
                               ConversionReport& report)
{
    const uint32_t index = entry.index;
    entry = {};
    for (unsigned int i = 0; i < imageCount(texture); ++i)
    {
        const osg::Image* image = texture.getImage(i);
        if (isMissing(image))
        {
            report.missing("missing.texture-image", image->getFileName(), "texture",
                           "shown without it");
            return false;
        }
        if (!image || !image->data())
        {
            report.count("approximated.texture-without-image");
            return false;
        }
        entry.images.push_back({image, image->getModifiedCount(), image->data()});
    }
    entry.index = index;
    entry.texture = &texture;
    entry.internalFormat = internalFormatOf(texture, texture.getImage(0));
    entry.minification = texture.getFilter(osg::Texture::MIN_FILTER);
    entry.converted = converted(texture, decode, report);
    return true;
}

std::shared_ptr<Texture> TextureConverter::converted(const osg::Texture& texture, bool decode,
                                                     ConversionReport& report) const
{
    const osg::Image& image = *texture.getImage(0);
    auto result = std::make_shared<Texture>();
    result->name = nameOf(texture, image);
    const auto bad = [&](const char* what, const char* message)
    {
        report.warn(what, "texture '" + result->name + "'", message);
        fillMagenta(*result);
    };
    if (isTooLarge(image, isVolume(texture) ? image.r() : 1))
        bad("approximated.texture-size", "more than 2^28 texels or 4 GiB, shown in magenta");
    else if (!decodeTexture(texture, *result))
        bad("approximated.pixel-format", "pixel format cannot be read, shown in magenta");
    result->decodeSrgb = decode && !result->bytes.empty();
    result->linearFilter = !isNearest(texture.getFilter(osg::Texture::MAG_FILTER));
    result->wrapS = wrapOf(texture, osg::Texture::WRAP_S);
    result->wrapT = wrapOf(texture, osg::Texture::WRAP_T);
    result->wrapR = wrapOf(texture, osg::Texture::WRAP_R);
    if (texture.getTextureTarget() == GL_TEXTURE_1D) result->wrapT = TextureWrap::ClampToEdge;
    result->border = borderOf(texture);
    setChannels(internalFormatOf(texture, &image), image.getPixelFormat(), *result);
    result->changed = _stamp;
    return result;
}

/// Gives the texture mips. Its osg::Image may be gone. shared: a scene may hold the texture.
void TextureConverter::addMips(Entry& entry, const osg::Texture& texture, bool shared) const
{
    const osg::Texture::FilterMode filter = texture.getFilter(osg::Texture::MIN_FILTER);
    const auto result = shared ? std::make_shared<Texture>(*entry.converted) : entry.converted;
    result->mips = textureMips(*result, !isNearest(filter));
    result->blendsMips = blendsMips(filter);
    result->changed = _stamp;
    entry.converted = result;
    entry.mips = true;
}

bool TextureConverter::knows(const osg::Texture& texture) const
{
    for (const bool decode : {false, true})
    {
        const auto known = _entries.find({&texture, decode});
        if (known != _entries.end() && known->second.converted &&
            known->second.texture.get() == &texture)
            return true;
    }
    return false;
}

/// Returns whether the entry's texture is unchanged. An image that was given up after it went to
/// OpenGL (setUnRefImageDataAfterApply) is: the texture that was converted before stays.
bool TextureConverter::isCurrent(const Entry& entry, const osg::Texture& texture) const
{
    if (!entry.converted || entry.texture.get() != &texture) return false;
    const Texture& old = *entry.converted;
    if (old.linearFilter == isNearest(texture.getFilter(osg::Texture::MAG_FILTER)) ||
        entry.minification != texture.getFilter(osg::Texture::MIN_FILTER) ||
        old.wrapS != wrapOf(texture, osg::Texture::WRAP_S) ||
        (old.wrapT != wrapOf(texture, osg::Texture::WRAP_T) && old.height > 1) ||
        (old.depth > 0 && old.wrapR != wrapOf(texture, osg::Texture::WRAP_R)) ||
        old.border != borderOf(texture))
        return false;
    const osg::Image* first = texture.getImage(0);
    if (first && entry.internalFormat != internalFormatOf(texture, first)) return false;
    for (unsigned int i = 0; i < entry.images.size(); ++i)
    {
        const osg::Image* image = texture.getImage(i);
        const ImageSignature& signature = entry.images[i];
        if (image &&
            (signature.image.get() != image || signature.modified != image->getModifiedCount() ||
             signature.data != image->data()))
            return false;
    }
    return true;
}

void TextureConverter::end()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.index == kInvalid ? _entries.erase(entry) : std::next(entry);
}

void TextureConverter::keepOnly(const std::vector<bool>& used)
{
    static const NeverDestroyed<std::shared_ptr<const Texture>> kept(
        []
        {
            auto texture = std::make_shared<Texture>();
            fillMagenta(*texture);
            return texture;
        }());
    const std::shared_ptr<const Texture>& nothing = *kept;
    for (uint32_t i = 0; i < _textures.size(); ++i)
    {
        if (used[i] || _textures[i] == nothing) continue;
        _textures[i] = nothing;
        _gaps.push_back(i);
    }
    for (auto entry = _entries.begin(); entry != _entries.end();)
    {
        const uint32_t index = entry->second.index;
        entry = index == kInvalid || !used[index] ? _entries.erase(entry) : std::next(entry);
    }
}

} // namespace osgRayTrace::engine
