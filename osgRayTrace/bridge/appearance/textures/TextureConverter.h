// TextureConverter.h - from osg::Texture to Texture, each converted once. Layer: bridge.
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

/// What an 8-bit texture holds.
enum class TextureContent
{
    Color, ///< sRGB encoded in a linear scene
    Data,  ///< roughness and the like: never decoded
};

/// True if OpenGL has texels of it, or will have, and it has no image: a camera renders to it, or
/// whoever fills it does so by OpenGL. Not so of a texture whose file is missing, which OpenGL does
/// not show either.
bool isOnlyInOpenGL(const osg::Texture& texture);

/// Keeps converted textures between snapshots, as long as they are used and their images unchanged.
class TextureConverter
{
public:
    /// Begins a snapshot. stamp is that of textures converted now.
    void begin(bool linear, Stamp stamp);

    /// Goes on with the last snapshot: indices stay, and what has changed is converted in its
    /// place.
    void resume(Stamp stamp) { _stamp = stamp; }

    /// Index into all(); kInvalid if there is nothing to sample (no image on the CPU). A
    /// format that cannot be read becomes magenta.
    /// 1-D, 2-D, 3-D, rectangle and cube textures; of arrays the first layer.
    uint32_t index(const osg::Texture* texture, TextureContent content, ConversionReport& report);

    /// True if it was converted, though it may have given up its image since.
    bool knows(const osg::Texture& texture) const;

    /// Of this snapshot.
    const Texture& at(uint32_t index) const { return *_textures[index]; }

    /// Of this snapshot. Where one was dropped there is another that nobody samples.
    const std::vector<std::shared_ptr<const Texture>>& all() const { return _textures; }

    /// Forgets what was not used in this snapshot.
    void end();

    /// Forgets those of the snapshot that are not used any more, by index.
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
        std::shared_ptr<const Texture> converted;
        uint32_t index = kInvalid; // in this snapshot
        Stamp looked = 0;          // at its image
    };

    bool isSrgb(const osg::Texture& texture) const;
    bool isCurrent(const Entry& entry, const osg::Texture& texture) const;
    bool convert(Entry& entry, const osg::Texture& texture, bool decode, ConversionReport& report);
    std::shared_ptr<Texture> converted(const osg::Texture& texture, bool decode,
                                       ConversionReport& report) const;

    std::map<Key, Entry> _entries;
    std::vector<std::shared_ptr<const Texture>> _textures;
    std::vector<uint32_t> _gaps; // in _textures
    bool _linear = false;
    Stamp _stamp = 0;
};

} // namespace osgRayTrace::engine
