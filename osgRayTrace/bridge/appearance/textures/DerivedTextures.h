// DerivedTextures.h - textures that are made of channels or layers of other textures. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Texture2D>
#include <osg/Texture2DArray>

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Names a channel of a texture.
struct ChannelSource
{
    const osg::Texture2D* texture = nullptr; ///< null: the channel is 1
    int channel = 0;                         ///< 0 to 3: red to alpha
    bool invert = false;                     ///< true: 1 - x

    auto key() const { return std::tie(texture, channel, invert); }
};

/// Keeps derived textures between conversions, as long as they are asked for. A derived texture is
/// made again if the image of a source has changed, in the same osg::Texture2D.
class DerivedTextures
{
public:
    void begin() { ++_round; }

    /// Returns a texture with these values in red, green and blue, of the largest size of the
    /// sources, with the wrap modes of the first one. Null: the texels of a source cannot be read.
    osg::Texture2D* ofChannels(const std::array<ChannelSource, 3>& channels);

    /// Returns the texture with its colours taken as encoded in sRGB, or as linear. Null: the
    /// texels cannot be read.
    osg::Texture2D* ofEncoding(const osg::Texture2D& texture, bool srgb);

    /// Returns a layer of an array as a texture of its own, which shares the image. Null: the layer
    /// has no image.
    osg::Texture2D* ofLayer(const osg::Texture2DArray& array, unsigned int layer);

    /// Forgets the textures that nobody has asked for since begin().
    void end();

private:
    /// 0: channels; 1: linear colours; 2: colours in sRGB.
    using Key = std::pair<int, std::array<std::tuple<const osg::Texture2D*, int, bool>, 3>>;

    struct Signature
    {
        osg::ref_ptr<const osg::Texture2D> texture; // keeps its address unique
        osg::ref_ptr<const osg::Image> image;
        unsigned int modified = 0;

        bool operator==(const Signature& other) const
        {
            return image == other.image && modified == other.modified;
        }
    };

    struct Entry
    {
        std::vector<Signature> sources;
        osg::ref_ptr<osg::Texture2D> derived; // null: a source cannot be read
        unsigned int used = 0;
    };

    template <class Make>
    osg::Texture2D* find(const Key& key, const std::vector<const osg::Texture2D*>& sources,
                         const Make& make);

    struct Layer
    {
        osg::ref_ptr<const osg::Texture2DArray> array; // keeps its address unique
        osg::ref_ptr<osg::Texture2D> texture;
        unsigned int used = 0;
    };

    std::map<Key, Entry> _entries;
    std::map<std::pair<const osg::Texture2DArray*, unsigned int>, Layer> _layers;
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
