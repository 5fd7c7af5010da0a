// TextureConverter.h - converts each osg::Texture once to a Texture. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/scene/Material.h"

#include <osg/Image>
#include <osg/Texture>
#include <osg/observer_ptr>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Names the kinds of content of an 8-bit texture.
enum class TextureContent
{
    Color,   ///< colours, sRGB encoded in a linear scene
    Data,    ///< data such as roughness, never decoded
    Normals, ///< normals, never decoded nor looked up in mips
};

/// Returns whether OpenGL has or will have texels of a texture that has no image: a camera renders
/// to it, or somebody fills it by OpenGL. A texture whose file is missing is not such a texture, as
/// OpenGL does not show it either.
bool isOnlyInOpenGL(const osg::Texture& texture);

/// Keeps converted textures between snapshots, as long as they are used and their images unchanged.
class TextureConverter
{
public:
    /// Begins a snapshot. stamp becomes the stamp of textures that are converted from now on.
    void begin(bool linear, Stamp stamp);

    /// Continues the last snapshot: indices stay, and a texture that has changed is converted in
    /// its place.
    void resume(Stamp stamp) { _stamp = stamp; }

    /// Returns the texture's index into all(); kInvalid if there is nothing to sample (no image on
    /// the CPU). A format that cannot be read becomes magenta. The texture may be 1-D, 2-D, 3-D,
    /// rectangle or cube; an array gives its first layer.
    uint32_t index(const osg::Texture* texture, TextureContent content, ConversionReport& report);

    /// Returns whether the texture was converted, though it may have given up its image since.
    bool knows(const osg::Texture& texture) const;

    /// Returns a texture of this snapshot.
    const Texture& at(uint32_t index) const { return *_textures[index]; }

    /// Returns the textures of this snapshot. A removed texture leaves another one in its place,
    /// which is never sampled.
    const std::vector<std::shared_ptr<const Texture>>& all() const { return _textures; }

    /// Forgets the textures that were not used in this snapshot.
    void end();

    /// Forgets the textures of the snapshot that are no longer used, by index.
    void keepOnly(const std::vector<bool>& used);

private:
    using Key = std::pair<const osg::Texture*, bool>; // bool: decode from sRGB

    struct ImageSignature
    {
        osg::observer_ptr<const osg::Image> image;
        unsigned int modified = 0;
        const void* data = nullptr;
    };

    struct Entry
    {
        osg::observer_ptr<const osg::Texture> texture; // tells a new object at an old address apart
        std::vector<ImageSignature> images;
        GLint internalFormat = 0;
        osg::Texture::FilterMode minification = osg::Texture::LINEAR;
        bool mips = false; // converted has the mips of the minification filter
        std::shared_ptr<Texture> converted;
        uint32_t index = kInvalid; // index in this snapshot
        Stamp looked = 0;          // stamp of the last comparison with the image
    };

    bool isSrgb(const osg::Texture& texture) const;
    bool isCurrent(const Entry& entry, const osg::Texture& texture) const;
    bool convert(Entry& entry, const osg::Texture& texture, bool decode, ConversionReport& report);
    std::shared_ptr<Texture> converted(const osg::Texture& texture, bool decode,
                                       ConversionReport& report) const;
    void addMips(Entry& entry, const osg::Texture& texture, bool shared) const;

    std::map<Key, Entry> _entries;
    std::vector<std::shared_ptr<const Texture>> _textures;
    std::vector<uint32_t> _gaps; // free indices of _textures
    bool _linear = false;
    Stamp _stamp = 0;
};

} // namespace osgRayTrace::engine
