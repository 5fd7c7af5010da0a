// RgbeConversion.cpp - decodes and encodes pixels of shared exponents. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/hdr/RgbeConversion.h"

#include "osgPlugins/exr/ExrError.h"

#include <osg/Texture>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kExponentBias = 136; ///< 128, and 8 for mantissas of integers
constexpr float kLargest = 255.0f * 0x1p119f;

/// osg::Image counts bytes in 32 bits.
constexpr long long kMaxImageBytes = 0xffffffff;

using Color = std::array<double, 3>;

/// Converts CIE X, Y, Z of luminances in candelas to linear radiance: Radiance takes 179 lumens for
/// a watt.
Color rgbFromXyz(const Color& xyz)
{
    constexpr double kEfficacy = 179.0;
    constexpr double kMatrix[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
    Color rgb{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            rgb[i] += kMatrix[i][k] * xyz[k] / kEfficacy;
    return rgb;
}

/// Decodes pixels to linear colours, for all of an image.
class Decoder
{
public:
    explicit Decoder(const RgbeImage& image) : _image(image)
    {
        for (int e = 1; e < 256; ++e)
            _scale[static_cast<std::size_t>(e)] = std::ldexp(1.0, e - kExponentBias);
    }

    Color operator()(const Rgbe& pixel) const
    {
        Color color;
        for (std::size_t c = 0; c < 3; ++c)
        {
            double value = pixel[c] * _scale[pixel[3]];
            if (_image.gamma != 1.0) value = std::pow(value, _image.gamma);
            color[c] = value / _image.factors[c];
        }
        return _image.xyz ? rgbFromXyz(color) : color;
    }

private:
    const RgbeImage& _image;
    std::array<double, 256> _scale{}; ///< factor of each exponent
};

float finite(double value)
{
    constexpr double kMost = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -kMost, kMost));
}

/// Returns the byte of a value in [0,1], cut off as OSG's plugin does it.
unsigned char byteOf(double value)
{
    return value > 0.0 ? static_cast<unsigned char>(std::min(value, 1.0) * 255.0) : 0;
}

osg::ref_ptr<osg::Image> allocated(const RgbeImage& image, RgbeKind kind)
{
    const bool raw = kind == RgbeKind::Raw, bytes = kind == RgbeKind::Bytes;
    const osg::ref_ptr<osg::Image> made = new osg::Image;
    made->allocateImage(image.width, image.height, 1, raw ? GL_RGBA : GL_RGB,
                        bytes ? GL_UNSIGNED_BYTE : GL_FLOAT);
    made->setInternalTextureFormat(raw ? GL_RGBA8 : bytes ? GL_RGB : GL_RGB32F_ARB);
    return made;
}

/// Encodes a colour with the exponent of its largest component, whose mantissa is then between 128
/// and 255.
Rgbe encoded(float r, float g, float b)
{
    const float values[] = {r, g, b};
    float sound[3] = {};
    for (int c = 0; c < 3; ++c)
        if (values[c] > 0.0f) sound[c] = std::min(values[c], kLargest);
    const float largest = std::max({sound[0], sound[1], sound[2]});
    int exponent = 0;
    if (std::frexp(largest, &exponent) >= 255.5f / 256.0f)
        ++exponent; // else the mantissa would be rounded to 256
    if (!(largest > 0.0f) || exponent <= -128) return {0, 0, 0, 0};
    Rgbe pixel;
    for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(
            std::min(std::lround(std::ldexp(sound[c], 8 - exponent)), 255L));
    pixel[3] = static_cast<std::uint8_t>(std::min(exponent + 128, 255));
    return pixel;
}

std::uint8_t byteOfUnit(float value)
{
    return value > 0.0f ? static_cast<std::uint8_t>(std::lround(std::min(value, 1.0f) * 255.0f))
                        : 0;
}

Rgbe pixelOf(const unsigned char* data, GLenum type, int components, bool raw)
{
    if (type == GL_UNSIGNED_BYTE) return {data[0], data[1], data[2], data[3]};
    const auto* values = reinterpret_cast<const float*>(data);
    if (raw)
        return {byteOfUnit(values[0]), byteOfUnit(values[1]), byteOfUnit(values[2]),
                byteOfUnit(values[3])};
    return components < 3 ? encoded(values[0], values[0], values[0])
                          : encoded(values[0], values[1], values[2]);
}

} // namespace

std::string toOsgImage(const RgbeImage& image, RgbeKind kind, float factor,
                       osg::ref_ptr<osg::Image>& result)
{
    constexpr long long kBytesOfPixel[] = {12, 3, 16};
    if (static_cast<long long>(image.width) * image.height * kBytesOfPixel[static_cast<int>(kind)] >
        kMaxImageBytes)
        return "an osg::Image cannot be that large";
    return caught(
        [&]
        {
            const osg::ref_ptr<osg::Image> made = allocated(image, kind);
            const Decoder decode(image);
            const Rgbe* pixel = image.pixels.data();
            for (int y = 0; y < image.height; ++y)
            {
                unsigned char* row = made->data(0, y);
                auto* floats = reinterpret_cast<float*>(row);
                for (int x = 0; x < image.width; ++x, ++pixel)
                {
                    if (kind == RgbeKind::Raw)
                    {
                        for (const std::uint8_t value : *pixel)
                            *floats++ = value / 255.0f;
                        continue;
                    }
                    for (const double value : decode(*pixel))
                        if (kind == RgbeKind::Float)
                            *floats++ = finite(value);
                        else
                            *row++ = byteOf(value * factor);
                }
            }
            result = made;
            return std::string();
        });
}

std::string toRgbeImage(const osg::Image& image, bool raw, RgbeImage& result)
{
    if (!image.data() || image.s() < 1 || image.t() < 1) return "the image is empty";
    if (image.r() != 1) return "a 3-D image cannot be written";
    const GLenum format = image.getPixelFormat(), type = image.getDataType();
    if (raw && (format != GL_RGBA || (type != GL_UNSIGNED_BYTE && type != GL_FLOAT)))
        return "only GL_RGBA of bytes or floats can be written raw";
    if (!raw && type != GL_FLOAT) return "only float pixels can be written";
    if (format != GL_RGB && format != GL_RGBA && format != GL_LUMINANCE)
        return "this pixel format cannot be written";
    if (!isRgbeSize(image.s(), image.t())) return "an image of this size cannot be written";
    return caught(
        [&]
        {
            RgbeImage made;
            made.width = image.s();
            made.height = image.t();
            made.pixels.reserve(static_cast<std::size_t>(image.s()) *
                                static_cast<std::size_t>(image.t()));
            const int components = static_cast<int>(osg::Image::computeNumComponents(format));
            const bool topDown = image.getOrigin() == osg::Image::TOP_LEFT;
            for (int y = 0; y < image.t(); ++y)
                for (int x = 0; x < image.s(); ++x)
                    made.pixels.push_back(pixelOf(image.data(x, topDown ? image.t() - 1 - y : y),
                                                  type, components, raw));
            result = std::move(made);
            return std::string();
        });
}

} // namespace osgRayTrace::engine
