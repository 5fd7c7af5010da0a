// TextureReader.cpp - reads images through osgDB, and WebP without it. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/TextureReader.h"

#include "osgPlugins/gltf/GltfError.h"
#include "osgPlugins/gltf/ImageSize.h"
#include "osgPlugins/gltf/Uri.h"
#include "osgPlugins/gltf/WebpImage.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::uint64_t kMostSets = 8;
constexpr std::uint64_t kMostPixels = std::uint64_t(1) << 26;
constexpr std::uint64_t kMostPixelsOfAll = std::uint64_t(1) << 29;
constexpr std::uint64_t kHeaderBytes = std::uint64_t(1) << 20; ///< an image's size is among them
constexpr std::uint64_t kMostWebpBytes = 4 * kMostPixels; ///< as many as the largest image decoded

osg::Texture::WrapMode wrapOf(const JsonPlace& sampler, const char* member)
{
    switch (sampler.wholeOr(member, GL_REPEAT))
    {
    case GL_REPEAT:
        return osg::Texture::REPEAT;
    case GL_CLAMP_TO_EDGE:
        return osg::Texture::CLAMP_TO_EDGE;
    case GL_MIRRORED_REPEAT_IBM:
        return osg::Texture::MIRROR;
    default:
        sampler.at(member).refuse("is no wrap mode");
    }
}

osg::Texture::FilterMode filterOf(const JsonPlace& sampler, const char* member,
                                  osg::Texture::FilterMode missing)
{
    const std::uint64_t filter = sampler.wholeOr(member, static_cast<std::uint64_t>(missing));
    const bool known = filter == GL_NEAREST || filter == GL_LINEAR ||
                       (filter >= GL_NEAREST_MIPMAP_NEAREST && filter <= GL_LINEAR_MIPMAP_LINEAR);
    if (!known) sampler.at(member).refuse("is no filter");
    return static_cast<osg::Texture::FilterMode>(filter);
}

/// Returns the extension of the plugin that reads an image of these first bytes; empty for others.
std::string formatOf(const std::string& bytes)
{
    if (bytes.compare(0, 4, "\x89PNG") == 0) return "png";
    if (bytes.compare(0, 3, "\xff\xd8\xff") == 0) return "jpeg";
    return "";
}

osg::ref_ptr<osg::Image> namedImage(const std::string& file)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setFileName(file);
    return image;
}

/// Reads an image file. osgDB reads it, so that its caches hold, unless the name is that of another
/// format, or means another file to osgDB, which looks into the folders of the options first.
osgDB::ReaderWriter::ReadResult readFile(const std::string& path, osgDB::ReaderWriter& plugin,
                                         const osgDB::Options* options)
{
    const bool sameToOsg = plugin.acceptsExtension(osgDB::getLowerCaseFileExtension(path)) &&
                           osgDB::findDataFile(path, options) == path;
    if (sameToOsg) return osgDB::Registry::instance()->readImage(path, options);
    std::ifstream stream(path, std::ios::binary);
    osgDB::ReaderWriter::ReadResult read = plugin.readImage(stream, options);
    if (read.validImage()) read.getImage()->setFileName(path);
    return read;
}

/// Returns the index of a texture's image: that of EXT_texture_webp if it can be read.
std::optional<JsonPlace> sourceOf(const JsonPlace& texture)
{
    const auto webp = texture.extension("EXT_texture_webp");
    const auto source = webp && readsWebp() ? webp->find("source") : std::nullopt;
    return source ? source : texture.find("source");
}

} // namespace

std::optional<TextureUse> TextureReader::read(const JsonPlace& holder, const char* member)
{
    const auto info = holder.find(member);
    if (!info) return std::nullopt;
    TextureUse use;
    std::uint64_t set = info->wholeOr("texCoord", 0);
    if (const auto transform = info->extension("KHR_texture_transform"))
    {
        use.transform = textureTransform(*transform);
        set = transform->wholeOr("texCoord", set);
    }
    if (set >= kMostSets) info->refuse("uses a set of coordinates above 7");
    use.set = static_cast<unsigned int>(set);
    use.texture = texture(info->at("index"));
    return use;
}

osg::ref_ptr<osg::Texture2D> TextureReader::texture(const JsonPlace& index)
{
    const std::size_t number = index.index(_document->count("textures"));
    osg::ref_ptr<osg::Texture2D>& held = _textures[number];
    if (held) return held;
    const JsonPlace place = _document->element("textures", number);
    const osg::ref_ptr<osg::Texture2D> made = new osg::Texture2D;
    made->setName(place.textOr("name", ""));
    made->setResizeNonPowerOfTwoHint(false);
    if (const auto source = sourceOf(place))
        made->setImage(image(*source).get());
    else
        _document->note(place.path() + ": has no source that is read");

    const auto at = place.indexOf("sampler", _document->count("samplers"));
    const JsonPlace sampler = at ? _document->element("samplers", *at) : JsonPlace::empty();
    made->setWrap(osg::Texture::WRAP_S, wrapOf(sampler, "wrapS"));
    made->setWrap(osg::Texture::WRAP_T, wrapOf(sampler, "wrapT"));
    made->setFilter(osg::Texture::MAG_FILTER, filterOf(sampler, "magFilter", osg::Texture::LINEAR));
    made->setFilter(osg::Texture::MIN_FILTER,
                    filterOf(sampler, "minFilter", osg::Texture::LINEAR_MIPMAP_LINEAR));
    held = made;
    return held;
}

osg::ref_ptr<osg::Image> TextureReader::image(const JsonPlace& index)
{
    const std::size_t number = index.index(_document->count("images"));
    osg::ref_ptr<osg::Image>& held = _images[number];
    if (held) return held;
    const JsonPlace place = _document->element("images", number);
    const auto uri = place.find("uri");
    try
    {
        held = uri && !isDataUri(uri->text()) ? imageBeside(*uri) : embeddedImage(place);
    }
    catch (const GltfError&)
    {
        throw;
    }
    catch (const std::bad_alloc&)
    {
        throw;
    }
    catch (...) // OSG's image plugins throw strings and what their libraries do
    {
        _document->note(place.path() + ": its image cannot be read");
    }
    if (!held) held = namedImage(place.textOr("name", place.path()));
    if (held->getName().empty()) held->setName(place.textOr("name", ""));
    return held;
}

/// Returns whether an image and all before it are of sizes within reason; notes it if not.
bool TextureReader::mayDecode(const std::string& begin, const JsonPlace& place)
{
    const std::uint64_t pixels = isWebp(begin) ? webpPixels(begin) : pixelsOf(begin);
    const bool good = pixels <= kMostPixels && pixels <= kMostPixelsOfAll - _pixels;
    if (pixels == 0)
        _document->note(place.path() + ": does not say its size in its first MiB");
    else if (good)
        _pixels += pixels;
    else
        _document->note(place.path() + ": has more than 2^26 pixels, or all images more than 2^29");
    return good && pixels > 0;
}

/// Returns the plugin for an image of these first bytes; null, with a note, if it is not to be
/// read.
osgDB::ReaderWriter* TextureReader::pluginFor(const std::string& begin, const JsonPlace& place)
{
    const std::string format = formatOf(begin);
    osgDB::ReaderWriter* plugin =
        format.empty() ? nullptr : osgDB::Registry::instance()->getReaderWriterForExtension(format);
    if (!plugin) _document->note(place.path() + ": is of a format that is not read");
    return plugin && mayDecode(begin, place) ? plugin : nullptr;
}

/// Returns the first bytes of an image file; nothing, with a note, if it cannot be read.
std::optional<std::string> TextureReader::beginOf(const std::string& path, const JsonPlace& uri)
{
    try
    {
        FileBytes file(path);
        std::string begin(static_cast<std::size_t>(std::min(file.size(), kHeaderBytes)), '\0');
        file.read(0, begin.size(), begin.data());
        return begin;
    }
    catch (const GltfError& error)
    {
        _document->note(uri.path() + ": " + error.what());
        return std::nullopt;
    }
}

/// Decodes a WebP image; null, with a note, if it is not to be read or cannot be.
osg::ref_ptr<osg::Image> TextureReader::webpImage(const std::string& bytes, const JsonPlace& place)
{
    if (!mayDecode(bytes, place)) return nullptr;
    const osg::ref_ptr<osg::Image> image = decodeWebp(bytes);
    if (!image)
    {
        _document->note(place.path() + ": its image cannot be read");
        return nullptr;
    }
    image->setWriteHint(osg::Image::STORE_INLINE); // OSG's readers cannot read its file
    return image;
}

/// Reads a WebP image file.
osg::ref_ptr<osg::Image> TextureReader::webpFile(const std::string& path, const JsonPlace& uri)
{
    FileBytes file(path);
    if (file.size() > kMostWebpBytes)
    {
        _document->note(uri.path() + ": '" + path + "' is too large for an image");
        return namedImage(path);
    }
    std::string bytes(static_cast<std::size_t>(file.size()), '\0');
    file.read(0, bytes.size(), bytes.data());
    const osg::ref_ptr<osg::Image> image = webpImage(bytes, uri);
    if (!image) return namedImage(path);
    image->setFileName(path);
    return image;
}

/// Reads an image file by the caller's options.
osg::ref_ptr<osg::Image> TextureReader::imageBeside(const JsonPlace& uri)
{
    const std::string path = _document->pathBeside(uri);
    const std::optional<std::string> begin = beginOf(path, uri);
    if (begin && readsWebp() && isWebp(*begin)) return webpFile(path, uri);
    osgDB::ReaderWriter* plugin = begin ? pluginFor(*begin, uri) : nullptr;
    if (!plugin) return namedImage(path);
    osgDB::ReaderWriter::ReadResult read = readFile(path, *plugin, _document->options().caller);
    if (read.validImage()) return read.getImage();
    _document->note(uri.path() + ": '" + path + "' cannot be read as an image");
    return namedImage(path);
}

/// Reads an image of a bufferView or of a data URI.
osg::ref_ptr<osg::Image> TextureReader::embeddedImage(const JsonPlace& place)
{
    std::string bytes;
    if (const auto uri = place.find("uri"))
        bytes = bytesOfDataUri(*uri);
    else
    {
        const ByteRange range =
            _document->bufferView(place.at("bufferView").index(_document->count("bufferViews")));
        _document->take(range.size, place);
        bytes.resize(static_cast<std::size_t>(range.size));
        range.read(0, bytes.size(), bytes.data());
    }
    if (readsWebp() && isWebp(bytes)) return webpImage(bytes, place);
    osgDB::ReaderWriter* plugin = pluginFor(bytes, place);
    if (!plugin) return nullptr;
    std::istringstream stream(bytes, std::ios::binary);
    osgDB::ReaderWriter::ReadResult read = plugin->readImage(stream, _document->options().caller);
    if (!read.validImage())
    {
        _document->note(place.path() + ": its image cannot be read");
        return nullptr;
    }
    const osg::ref_ptr<osg::Image> image = read.getImage();
    image->setFileName(""); // it has no file: .osgb must hold its pixels
    image->setWriteHint(osg::Image::STORE_INLINE);
    return image;
}

/// glTF turns coordinates (u, v), v downwards, into T * R * S * (u, v, 1). OSG's are (u, 1 - v), in
/// which the same rotation is counter-clockwise.
TextureTransform textureTransform(const JsonPlace& place)
{
    const auto offset = place.numbersOr<2>("offset", {0.0f, 0.0f});
    const auto scale = place.numbersOr<2>("scale", {1.0f, 1.0f});
    TextureTransform transform;
    transform.rotation = place.numberOr("rotation", 0.0f);
    transform.scale.set(scale[0], scale[1]);
    transform.offset.set(offset[0] + std::sin(transform.rotation) * scale[1],
                         1.0f - offset[1] - std::cos(transform.rotation) * scale[1]);
    return transform;
}

osg::Matrix TextureTransform::toMatrix() const
{
    const double c = std::cos(rotation), s = std::sin(rotation);
    osg::Matrix matrix;
    matrix(0, 0) = c * scale.x();
    matrix(0, 1) = s * scale.x();
    matrix(1, 0) = -s * scale.y();
    matrix(1, 1) = c * scale.y();
    matrix(3, 0) = offset.x();
    matrix(3, 1) = offset.y();
    return matrix;
}

} // namespace osgRayTrace::gltf
