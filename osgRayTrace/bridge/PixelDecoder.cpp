// PixelDecoder.cpp - pixel formats times pixel types. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/PixelDecoder.h"

#include <glm/gtc/packing.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kZero = -1; ///< a channel that is 0
constexpr int kOne = -2;  ///< a channel that is 1

/// Where red, green, blue and alpha stand in a pixel of so many components.
struct Layout
{
    int components;
    int channel[4];
};

std::optional<Layout> layoutOf(GLenum format)
{
    switch (format)
    {
    case GL_RGBA:
        return Layout{4, {0, 1, 2, 3}};
    case GL_BGRA:
        return Layout{4, {2, 1, 0, 3}};
    case GL_RGB:
        return Layout{3, {0, 1, 2, kOne}};
    case GL_BGR:
        return Layout{3, {2, 1, 0, kOne}};
    case GL_LUMINANCE:
    case GL_DEPTH_COMPONENT:
        return Layout{1, {0, 0, 0, kOne}};
    case GL_LUMINANCE_ALPHA:
        return Layout{2, {0, 0, 0, 1}};
    case GL_INTENSITY:
        return Layout{1, {0, 0, 0, 0}};
    case GL_ALPHA:
        return Layout{1, {kOne, kOne, kOne, 0}};
    case GL_RED:
        return Layout{1, {0, kZero, kZero, kOne}};
    case GL_RG:
        return Layout{2, {0, 1, kZero, kOne}};
    default:
        return std::nullopt;
    }
}

struct Half
{
    uint16_t bits;
};

template <class Scalar> float toFloat(Scalar value)
{
    if constexpr (std::is_integral_v<Scalar>)
        return static_cast<float>(static_cast<double>(value) / std::numeric_limits<Scalar>::max());
    else
        return static_cast<float>(value);
}

float toFloat(Half value)
{
    return glm::unpackHalf1x16(value.bits);
}

float finiteOrZero(float value)
{
    return std::isfinite(value) ? value : 0.0f;
}

/// Rows as the image has them: packing and row length make a row longer than its pixels.
template <class Scalar, class Value, class Convert>
void decodeRows(const osg::Image& image, const Layout& layout, Value one, const Convert& convert,
                std::vector<Value>& out)
{
    const int width = image.s();
    const int height = image.t();
    out.resize(static_cast<std::size_t>(width) * height * 4);
    Value* pixel = out.data();
    for (int y = 0; y < height; ++y)
    {
        const auto* source = reinterpret_cast<const Scalar*>(image.data(0, y));
        for (int x = 0; x < width; ++x, source += layout.components, pixel += 4)
            for (int c = 0; c < 4; ++c)
            {
                const int from = layout.channel[c];
                pixel[c] = from >= 0 ? convert(source[from]) : from == kOne ? one : Value(0);
            }
    }
}

template <class Scalar>
void decodeFloats(const osg::Image& image, const Layout& layout, Texture& texture)
{
    decodeRows<Scalar>(
        image, layout, 1.0f, [](Scalar value) { return finiteOrZero(toFloat(value)); },
        texture.floats);
}

bool decodePlain(const osg::Image& image, Texture& texture)
{
    const auto layout = layoutOf(image.getPixelFormat());
    if (!layout) return false;
    switch (image.getDataType())
    {
    case GL_UNSIGNED_BYTE:
        decodeRows<uint8_t>(
            image, *layout, uint8_t(255), [](uint8_t value) { return value; }, texture.bytes);
        return true;
    case GL_BYTE:
        decodeFloats<int8_t>(image, *layout, texture);
        return true;
    case GL_UNSIGNED_SHORT:
        decodeFloats<uint16_t>(image, *layout, texture);
        return true;
    case GL_SHORT:
        decodeFloats<int16_t>(image, *layout, texture);
        return true;
    case GL_UNSIGNED_INT:
        decodeFloats<uint32_t>(image, *layout, texture);
        return true;
    case GL_INT:
        decodeFloats<int32_t>(image, *layout, texture);
        return true;
    case GL_HALF_FLOAT:
        decodeFloats<Half>(image, *layout, texture);
        return true;
    case GL_FLOAT:
        decodeFloats<float>(image, *layout, texture);
        return true;
    default:
        return false;
    }
}

bool isDxt(GLenum format)
{
    return format == GL_COMPRESSED_RGB_S3TC_DXT1_EXT ||
           format == GL_COMPRESSED_RGBA_S3TC_DXT1_EXT ||
           format == GL_COMPRESSED_RGBA_S3TC_DXT3_EXT || format == GL_COMPRESSED_RGBA_S3TC_DXT5_EXT;
}

void decodeDxt(const osg::Image& image, Texture& texture)
{
    texture.bytes.resize(static_cast<std::size_t>(image.s()) * image.t() * 4);
    uint8_t* pixel = texture.bytes.data();
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x, pixel += 4)
        {
            const osg::Vec4 color = image.getColor(x, y);
            for (int c = 0; c < 4; ++c)
                pixel[c] = static_cast<uint8_t>(std::lround(255.0f * color[c]));
        }
}

} // namespace

bool decodePixels(const osg::Image& image, Texture& texture)
{
    if (!image.data() || image.s() < 1 || image.t() < 1) return false;
    if (image.isCompressed())
    {
        if (!isDxt(image.getPixelFormat())) return false;
        decodeDxt(image, texture);
    }
    else if (!decodePlain(image, texture))
        return false;
    texture.width = image.s();
    texture.height = image.t();
    return true;
}

} // namespace osgRayTrace::engine
