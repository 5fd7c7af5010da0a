// PixelDecoder.cpp - decodes pixel formats times pixel types. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/PixelDecoder.h"

#include "osgRayTrace/bridge/appearance/textures/BlockDecoder.h"

#include <glm/gtc/packing.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kZero = -1; ///< channel that is 0
constexpr int kOne = -2;  ///< channel that is 1

// OpenGL 3.0 defines these types, which OSG's headers do not name.
constexpr GLenum kSmallFloatType = 0x8C3B;     ///< GL_UNSIGNED_INT_10F_11F_11F_REV
constexpr GLenum kSharedExponentType = 0x8C3E; ///< GL_UNSIGNED_INT_5_9_9_9_REV

/// Tells where red, green, blue and alpha stand in a pixel of so many components.
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
    case GL_GREEN:
        return Layout{1, {kZero, 0, kZero, kOne}};
    case GL_BLUE:
        return Layout{1, {kZero, kZero, 0, kOne}};
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

/// Decodes the rows as the image stores them: packing and row length make a row longer than its
/// pixels.
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

/// Describes a pixel whose components share one number: the first component has the highest bits,
/// or the lowest if the type is reversed.
struct Packing
{
    int bytes;
    int components;
    int bits[4];
    bool reversed;
};

std::optional<Packing> packingOf(GLenum type)
{
    switch (type)
    {
    case GL_UNSIGNED_BYTE_3_3_2:
        return Packing{1, 3, {3, 3, 2, 0}, false};
    case GL_UNSIGNED_BYTE_2_3_3_REV:
        return Packing{1, 3, {3, 3, 2, 0}, true};
    case GL_UNSIGNED_SHORT_5_6_5:
        return Packing{2, 3, {5, 6, 5, 0}, false};
    case GL_UNSIGNED_SHORT_5_6_5_REV:
        return Packing{2, 3, {5, 6, 5, 0}, true};
    case GL_UNSIGNED_SHORT_4_4_4_4:
        return Packing{2, 4, {4, 4, 4, 4}, false};
    case GL_UNSIGNED_SHORT_4_4_4_4_REV:
        return Packing{2, 4, {4, 4, 4, 4}, true};
    case GL_UNSIGNED_SHORT_5_5_5_1:
        return Packing{2, 4, {5, 5, 5, 1}, false};
    case GL_UNSIGNED_SHORT_1_5_5_5_REV:
        return Packing{2, 4, {5, 5, 5, 1}, true};
    case GL_UNSIGNED_INT_8_8_8_8:
        return Packing{4, 4, {8, 8, 8, 8}, false};
    case GL_UNSIGNED_INT_8_8_8_8_REV:
        return Packing{4, 4, {8, 8, 8, 8}, true};
    case GL_UNSIGNED_INT_10_10_10_2:
        return Packing{4, 4, {10, 10, 10, 2}, false};
    case GL_UNSIGNED_INT_2_10_10_10_REV:
        return Packing{4, 4, {10, 10, 10, 2}, true};
    default:
        return std::nullopt;
    }
}

/// Returns the number of a pixel in the byte order of the machine, as OpenGL reads it [OpenGL21,
/// table 3.8].
uint32_t packedPixel(const uint8_t* source, int bytes)
{
    uint32_t value = 0;
    uint16_t half;
    switch (bytes)
    {
    case 1:
        return *source;
    case 2:
        std::memcpy(&half, source, sizeof half);
        return half;
    default:
        std::memcpy(&value, source, sizeof value);
        return value;
    }
}

bool decodePacked(const osg::Image& image, const Packing& packing, Texture& texture)
{
    const auto layout = layoutOf(image.getPixelFormat());
    if (!layout || layout->components != packing.components) return false;
    texture.bytes.resize(static_cast<std::size_t>(image.s()) * image.t() * 4);
    uint8_t* out = texture.bytes.data();
    for (int y = 0; y < image.t(); ++y)
    {
        const uint8_t* source = image.data(0, y);
        for (int x = 0; x < image.s(); ++x, source += packing.bytes, out += 4)
        {
            const uint32_t pixel = packedPixel(source, packing.bytes);
            uint8_t values[4] = {};
            int low = packing.reversed ? 0 : 8 * packing.bytes;
            for (int c = 0; c < packing.components; ++c)
            {
                const int bits = packing.bits[c];
                if (!packing.reversed) low -= bits;
                const uint32_t largest = (1u << bits) - 1u;
                values[c] =
                    static_cast<uint8_t>(((pixel >> low & largest) * 255u + largest / 2) / largest);
                if (packing.reversed) low += bits;
            }
            for (int c = 0; c < 4; ++c)
            {
                const int from = layout->channel[c];
                out[c] = from >= 0 ? values[from] : from == kOne ? 255 : 0;
            }
        }
    }
    return true;
}

/// Decodes three numbers without sign that have a common exponent, or an exponent each [OpenGL30,
/// sect. 2.1.3 and 3.9.1].
bool decodeSharedExponent(const osg::Image& image, Texture& texture)
{
    const bool shared = image.getDataType() == kSharedExponentType;
    if (image.getPixelFormat() != GL_RGB) return false;
    texture.floats.resize(static_cast<std::size_t>(image.s()) * image.t() * 4);
    float* out = texture.floats.data();
    for (int y = 0; y < image.t(); ++y)
    {
        const uint8_t* source = image.data(0, y);
        for (int x = 0; x < image.s(); ++x, source += 4, out += 4)
        {
            const uint32_t pixel = packedPixel(source, 4);
            const Vec3 color =
                shared ? Vec3(glm::unpackF3x9_E1x5(pixel)) : Vec3(glm::unpackF2x11_1x10(pixel));
            for (int c = 0; c < 3; ++c)
                out[c] = finiteOrZero(color[c]);
            out[3] = 1.0f;
        }
    }
    return true;
}

} // namespace

bool decodePixels(const osg::Image& image, Texture& texture)
{
    if (!image.data() || image.s() < 1 || image.t() < 1) return false;
    if (image.isCompressed())
    {
        if (!decodeBlocks(image, texture)) return false;
    }
    else if (const auto packing = packingOf(image.getDataType()))
    {
        if (!decodePacked(image, *packing, texture)) return false;
    }
    else if (image.getDataType() == kSharedExponentType || image.getDataType() == kSmallFloatType)
    {
        if (!decodeSharedExponent(image, texture)) return false;
    }
    else if (!decodePlain(image, texture))
        return false;
    texture.width = image.s();
    texture.height = image.t();
    return true;
}

} // namespace osgRayTrace::engine
