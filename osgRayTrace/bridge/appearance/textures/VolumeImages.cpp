// VolumeImages.cpp - decodes slices of images into voxels. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/VolumeImages.h"

#include "osgRayTrace/bridge/appearance/textures/PixelDecoder.h"
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/scene/VolumeLimits.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the channel of a decoded pixel that is the value of the voxel; -1: all four are voxels.
int soleChannel(const osg::Image& image)
{
    switch (image.getPixelFormat())
    {
    case GL_ALPHA:
        return 3;
    case GL_LUMINANCE:
    case GL_INTENSITY:
        return 0;
    default:
        return -1;
    }
}

/// Returns the number of values of an image that are not finite or too large.
uint64_t repairedValues(const osg::Image& image)
{
    if (image.getDataType() != GL_FLOAT) return 0;
    uint64_t count = 0;
    const auto values =
        image.s() * static_cast<int>(osg::Image::computeNumComponents(image.getPixelFormat()));
    for (int r = 0; r < image.r(); ++r)
        for (int t = 0; t < image.t(); ++t)
        {
            const auto* row = reinterpret_cast<const float*>(image.data(0, t, r));
            for (int i = 0; i < values; ++i)
                count += !(std::fabs(row[i]) <= kLargestVoxel);
        }
    return count;
}

template <class T>
void append(const std::vector<T>& pixels, int channel, std::vector<T>& voxels, uint64_t values)
{
    if (voxels.empty() && !pixels.empty()) voxels.reserve(values);
    if (channel < 0)
    {
        voxels.insert(voxels.end(), pixels.begin(), pixels.end());
        return;
    }
    for (std::size_t i = static_cast<std::size_t>(channel); i < pixels.size(); i += 4)
        voxels.push_back(pixels[i]);
}

/// Decodes the colours of voxels; the values stay.
void decodeColors(VolumeImage& image)
{
    if (image.floats.empty())
    {
        image.floats.reserve(image.bytes.size());
        for (const uint8_t byte : image.bytes)
            image.floats.push_back(static_cast<float>(byte) * (1.0f / 255.0f));
        image.bytes.clear();
        image.bytes.shrink_to_fit();
    }
    for (std::size_t i = 0; i < image.floats.size(); ++i)
        if (i % 4 != 3) image.floats[i] = linearFromSrgb(image.floats[i]);
}

VolumeImages::Result decoded(const osg::Image& source, bool linear, bool valuesAlone = false)
{
    VolumeImages::Result result;
    result.fault = "its image is empty";
    if (!source.data() || source.s() < 1 || source.t() < 1 || source.r() < 1) return result;
    result.fault = "its image is of a format that cannot be read";
    if (source.isCompressed()) return result;
    constexpr int kAlpha = 3;
    const int sole = soleChannel(source);
    const int channel = sole < 0 && valuesAlone ? kAlpha : sole;
    const uint64_t values = uint64_t(static_cast<unsigned int>(source.s())) *
                            static_cast<unsigned int>(source.t()) *
                            static_cast<unsigned int>(source.r()) * (channel < 0 ? 4u : 1u);
    result.fault = "its image has more than 536,870,912 values, or 16,384 along a side";
    if (std::max({source.s(), source.t(), source.r()}) > kMostVoxelSide) return result;
    if (values > kMostVoxelValues) return result;

    const auto image = std::make_shared<VolumeImage>();
    image->width = source.s();
    image->height = source.t();
    image->depth = source.r();
    image->channels = channel < 0 ? 4 : 1;
    result.fault = "its image is of a format that cannot be read";
    for (int r = 0; r < source.r(); ++r)
    {
        // Refers to the image's memory, and is only read.
        const osg::ref_ptr<osg::Image> slice = new osg::Image;
        slice->setImage(source.s(), source.t(), 1, source.getInternalTextureFormat(),
                        source.getPixelFormat(), source.getDataType(),
                        const_cast<unsigned char*>(source.data(0, 0, r)), osg::Image::NO_DELETE,
                        static_cast<int>(source.getPacking()), source.getRowLength());
        Texture pixels;
        if (!decodePixels(*slice, pixels)) return result;
        append(pixels.bytes, channel, image->bytes, values);
        append(pixels.floats, channel, image->floats, values);
    }
    result.repaired = repairedValues(source);
    for (float& value : image->floats)
        value = std::isfinite(value) ? std::clamp(value, -kLargestVoxel, kLargestVoxel) : 0.0f;
    if (linear && image->channels == 4) decodeColors(*image);
    result.fault = nullptr;
    result.image = image;
    return result;
}

} // namespace

VolumeImages::Result VolumeImages::convert(const osg::Image& image, bool linear)
{
    for (Entry& entry : _entries)
    {
        if (entry.source.get() != &image || entry.linear != linear) continue;
        entry.used = true;
        if (entry.modified == image.getModifiedCount() && entry.data == image.data())
            return entry.result;
        entry.modified = image.getModifiedCount();
        entry.data = image.data();
        entry.result = decoded(image, linear);
        return entry.result;
    }
    _entries.push_back(
        {&image, image.getModifiedCount(), image.data(), linear, true, decoded(image, linear)});
    return _entries.back().result;
}

VolumeImages::Result VolumeImages::values(const osg::Image& image)
{
    return decoded(image, false, true);
}

void VolumeImages::end()
{
    _entries.erase(std::remove_if(_entries.begin(), _entries.end(),
                                  [](const Entry& entry)
                                  { return !entry.used || !entry.source.valid(); }),
                   _entries.end());
    for (Entry& entry : _entries)
        entry.used = false;
}

} // namespace osgRayTrace::engine
