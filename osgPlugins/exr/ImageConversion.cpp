// ImageConversion.cpp - interleaves channels, and takes images apart. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ImageConversion.h"

#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/exr/ImageLayout.h"
#include "osgRayTrace/base/NeverDestroyed.h"

#include <half.h>

#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// osg::Image counts bytes in 32 bits.
constexpr std::size_t kMaxImageBytes = 0xffffffff;

float linearFromSrgbByte(unsigned char byte)
{
    const float encoded = byte / 255.0f;
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Returns the byte of a value in [0,1]; not a number gives 0.
unsigned char byteFromUnit(float value)
{
    if (!(value > 0.0f)) return 0;
    return value < 1.0f ? static_cast<unsigned char>(value * 255.0f + 0.5f) : 255;
}

unsigned char srgbByteFromLinear(float linear)
{
    if (linear <= 0.0031308f) return byteFromUnit(linear * 12.92f);
    return byteFromUnit(1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f);
}

/// Reads the linear value at an address in an image of a supported type.
class ValueReader
{
public:
    ValueReader(GLenum type, bool alpha) : _type(type)
    {
        for (int byte = 0; byte < 256; ++byte)
        {
            _linear[byte] =
                alpha ? byte / 255.0f : linearFromSrgbByte(static_cast<unsigned char>(byte));
        }
    }

    float operator()(const unsigned char* address) const
    {
        if (_type == GL_UNSIGNED_BYTE) return _linear[*address];
        if (_type == GL_HALF_FLOAT) return read<half>(address);
        return read<float>(address);
    }

private:
    template <class Value> static float read(const unsigned char* address)
    {
        Value value;
        std::memcpy(&value, address, sizeof(value));
        return value;
    }

    GLenum _type;
    float _linear[256];
};

std::size_t sizeOf(GLenum type)
{
    if (type == GL_FLOAT) return sizeof(float);
    if (type == GL_HALF_FLOAT) return sizeof(half);
    return type == GL_UNSIGNED_BYTE ? 1 : 0;
}

/// Writes one component of every pixel, 0 if there is no such channel. convert: turns a float into
/// a Value.
template <class Value, class Convert>
void interleave(const ExrChannel* channel, std::size_t component, std::size_t components,
                osg::Image& image, const Convert& convert)
{
    const std::size_t width = image.s();
    for (int y = 0; y < image.t(); ++y)
    {
        auto* row = reinterpret_cast<Value*>(image.data(0, y));
        const float* values = channel ? channel->values.data() + y * width : nullptr;
        for (std::size_t x = 0; x < width; ++x)
        {
            row[x * components + component] = convert(values ? values[x] : 0.0f);
        }
    }
}

void interleaveAs(GLenum type, const ExrChannel* channel, std::size_t component,
                  std::size_t components, osg::Image& image)
{
    const auto same = [](float value) { return value; };
    const bool alpha = channel && channel->name == "A";
    if (type == GL_FLOAT)
        interleave<float>(channel, component, components, image, same);
    else if (type == GL_HALF_FLOAT)
        interleave<half>(channel, component, components, image, same);
    else
        interleave<unsigned char>(channel, component, components, image,
                                  alpha ? byteFromUnit : srgbByteFromLinear);
}

/// Returns all channels of image; the caller has checked that layout and image fit.
ExrImage deinterleave(const osg::Image& image, const ImageLayout& layout, bool asHalf)
{
    ExrImage result;
    result.width = image.s();
    result.height = image.t();
    const std::size_t components = layout.channels.size();
    const std::size_t valueBytes = sizeOf(image.getDataType());
    const bool topDown = image.getOrigin() == osg::Image::TOP_LEFT;
    for (std::size_t component = 0; component < components; ++component)
    {
        ExrChannel channel{layout.channels[component], asHalf, {}};
        channel.values.reserve(static_cast<std::size_t>(image.s()) * image.t());
        const ValueReader valueAt(image.getDataType(), channel.name == "A");
        for (int y = 0; y < image.t(); ++y)
        {
            const unsigned char* row = image.data(0, topDown ? image.t() - 1 - y : y);
            for (int x = 0; x < image.s(); ++x)
            {
                channel.values.push_back(valueAt(row + (x * components + component) * valueBytes));
            }
        }
        result.channels.push_back(std::move(channel));
    }
    return result;
}

} // namespace

const std::vector<std::string>& exrColorChannels()
{
    static const engine::NeverDestroyed<std::vector<std::string>> names(
        std::vector<std::string>{"R", "G", "B", "A", "Y"});
    return *names;
}

std::string toOsgImage(const ExrImage& image, GLenum type, osg::ref_ptr<osg::Image>& result)
{
    const GLenum format = formatOf(image);
    if (format == GL_NONE) return "there is none of the channels R, G, B, Y and A";
    const ImageLayout& layout = layoutOf(format);
    const std::size_t components = layout.channels.size();
    const std::size_t sizeBytes = components * sizeOf(type) * image.width * image.height;
    if (sizeBytes > kMaxImageBytes) return "an osg::Image cannot be that large";

    return caught(
        [&]
        {
            const osg::ref_ptr<osg::Image> made = new osg::Image;
            made->allocateImage(image.width, image.height, 1, format, type);
            made->setInternalTextureFormat(layout.internalFormat(type));
            for (std::size_t component = 0; component < components; ++component)
            {
                const ExrChannel* channel = image.find(layout.channels[component]);
                interleaveAs(type, channel, component, components, *made);
            }
            result = made;
            return std::string();
        });
}

std::string toExrImage(const osg::Image& image, bool asHalf, ExrImage& result)
{
    if (!image.data() || image.s() < 1 || image.t() < 1) return "the image is empty";
    if (image.r() != 1) return "a 3-D image cannot be written";
    const ImageLayout& layout = layoutOf(image.getPixelFormat());
    if (layout.channels.empty()) return "this pixel format cannot be written";
    if (sizeOf(image.getDataType()) == 0) return "only float, half and byte pixels can be written";

    return caught(
        [&]
        {
            result = deinterleave(image, layout, asHalf);
            return std::string();
        });
}

} // namespace osgRayTrace::engine
