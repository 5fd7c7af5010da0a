// TextureConverter.h - from osg::Texture2D to Texture, each converted once. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/ConversionReport.h"
#include "osgRayTrace/scene/Material.h"

#include <osg/Image>
#include <osg/Texture2D>
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

/// Keeps converted textures between snapshots, as long as they are used and their images unchanged.
class TextureConverter
{
public:
    /// Begins a snapshot. stamp is that of textures converted now.
    void begin(bool linear, Stamp stamp);

    /// Index into textures(); kInvalid if there is nothing to sample (no image on the CPU). A
    /// format that cannot be read becomes magenta.
    uint32_t index(const osg::Texture2D* texture, TextureContent content, ConversionReport& report);

    /// Ends the snapshot: its textures. Forgets what was not used in it.
    std::vector<std::shared_ptr<const Texture>> end();

private:
    using Key = std::pair<const osg::Texture2D*, bool>; // bool: decode from sRGB

    struct Entry
    {
        osg::observer_ptr<const osg::Texture2D>
            texture; // tells a new object at an old address apart
        osg::observer_ptr<const osg::Image> image;
        unsigned int imageModified = 0;
        const void* imageData = nullptr;
        std::shared_ptr<const Texture> converted;
        uint32_t index = kInvalid; // in this snapshot
    };

    bool isCurrent(const Entry& entry, const osg::Texture2D& texture) const;

    std::map<Key, Entry> _entries;
    std::vector<std::shared_ptr<const Texture>> _textures;
    bool _linear = false;
    Stamp _stamp = 0;
};

} // namespace osgRayTrace::engine
