// TextureReader.h - textures with their images, samplers and transforms. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Document.h"

#include <osg/Image>
#include <osg/Matrix>
#include <osg/Texture2D>
#include <osgDB/ReaderWriter>

#include <map>
#include <optional>

namespace osgRayTrace::gltf
{

/// Where a texture is looked up: at offset + rotation * (scale * coordinates), whose v goes up.
struct TextureTransform
{
    osg::Vec2 offset{0.0f, 0.0f};
    float rotation = 0.0f; ///< counter-clockwise [radians]
    osg::Vec2 scale{1.0f, 1.0f};

    osg::Matrix toMatrix() const;
};

/// A texture as a material uses it.
struct TextureUse
{
    osg::ref_ptr<osg::Texture2D> texture;
    unsigned int set = 0; ///< the UV set, which is in the texture unit of this number
    std::optional<TextureTransform> transform;
};

class TextureReader
{
public:
    explicit TextureReader(Document& document) : _document(&document) {}

    /// Reads the texture that a member of a material is; nothing if there is no such member. Throws
    /// GltfError. An image that cannot be read is noted, and the texture has its name alone.
    std::optional<TextureUse> read(const JsonPlace& holder, const char* member);

private:
    osg::ref_ptr<osg::Texture2D> texture(const JsonPlace& place);
    osg::ref_ptr<osg::Image> image(const JsonPlace& place);
    osg::ref_ptr<osg::Image> imageBeside(const JsonPlace& uri);
    osg::ref_ptr<osg::Image> embeddedImage(const JsonPlace& image);
    osg::ref_ptr<osg::Image> webpImage(const std::string& bytes, const JsonPlace& place);
    osg::ref_ptr<osg::Image> webpFile(const std::string& path, const JsonPlace& uri);
    bool mayDecode(const std::string& begin, const JsonPlace& place);
    osgDB::ReaderWriter* pluginFor(const std::string& begin, const JsonPlace& place);
    std::optional<std::string> beginOf(const std::string& path, const JsonPlace& uri);

    Document* _document;
    std::map<std::size_t, osg::ref_ptr<osg::Texture2D>> _textures;
    std::map<std::size_t, osg::ref_ptr<osg::Image>> _images;
    std::uint64_t _pixels = 0; ///< of all images
};

/// Returns the transform of KHR_texture_transform for coordinates whose v goes up.
TextureTransform textureTransform(const JsonPlace& place);

} // namespace osgRayTrace::gltf
