// TextureSample.cpp - wrapping, filtering and decoding of texels. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/TextureSample.h"

#include "osgRayTrace/base/Kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

const std::array<float, 256>& decodedBytes()
{
    static const std::array<float, 256> table = []
    {
        std::array<float, 256> values{};
        for (int i = 0; i < 256; ++i)
        {
            const double x = i / 255.0;
            const double y = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
            values[static_cast<std::size_t>(i)] = static_cast<float>(y);
        }
        return values;
    }();
    return table;
}

namespace
{

/// Returns the texel index in [0, size) of any integer position.
int wrapped(int i, int size, TextureWrap wrap)
{
    if (wrap != TextureWrap::Repeat && wrap != TextureWrap::Mirror)
        return i < 0 ? 0 : i >= size ? size - 1 : i;
    const int period = wrap == TextureWrap::Mirror ? 2 * size : size;
    int m = i % period;
    if (m < 0) m += period;
    return m < size ? m : period - 1 - m;
}

bool hasBorder(TextureWrap wrap)
{
    return wrap == TextureWrap::Clamp || wrap == TextureWrap::ClampToBorder;
}

/// Returns the border colour; OpenGL's borders are data and are decoded like texels.
Vec4 borderOf(const Texture& texture)
{
    Vec4 color = texture.border;
    if (texture.decodeSrgb)
        for (int c = 0; c < 3; ++c)
            color[c] = decodedBytes()[static_cast<std::size_t>(
                std::lround(255.0f * std::fmin(std::fmax(color[c], 0.0f), 1.0f)))];
    return color;
}

/// Returns a texel. slice: index within a 3-D image.
Vec4 texel(const Texture& texture, int x, int y, int slice = 0)
{
    if ((hasBorder(texture.wrapS) && (x < 0 || x >= texture.width)) ||
        (hasBorder(texture.wrapT) && (y < 0 || y >= texture.height)))
        return borderOf(texture);
    const std::size_t at =
        4 * ((static_cast<std::size_t>(slice) * static_cast<std::size_t>(texture.height) +
              static_cast<std::size_t>(wrapped(y, texture.height, texture.wrapT))) *
                 static_cast<std::size_t>(texture.width) +
             static_cast<std::size_t>(wrapped(x, texture.width, texture.wrapS)));
    if (!texture.floats.empty())
        return Vec4(texture.floats[at], texture.floats[at + 1], texture.floats[at + 2],
                    texture.floats[at + 3]);
    const uint8_t* b = &texture.bytes[at];
    if (texture.decodeSrgb)
    {
        const std::array<float, 256>& linear = decodedBytes();
        return Vec4(linear[b[0]], linear[b[1]], linear[b[2]], b[3] * (1.0f / 255.0f));
    }
    return Vec4(b[0], b[1], b[2], b[3]) * (1.0f / 255.0f);
}

/// Returns a coordinate in texels, within the range of an int; NaN becomes 0. TextureWrap::Clamp
/// keeps the coordinate within the image [OpenGL21, sect. 3.8.7].
float texels(float coordinate, int size, TextureWrap wrap)
{
    if (wrap == TextureWrap::Clamp) coordinate = std::fmin(std::fmax(coordinate, 0.0f), 1.0f);
    const float value = coordinate * static_cast<float>(size);
    return std::fabs(value) < 1e9f ? value : 0.0f;
}

/// Returns the index of the nearest texel; with that filter the coordinate 1 is the last texel, not
/// the border.
int nearest(float texelsOf, int size, TextureWrap wrap)
{
    const int i = static_cast<int>(std::floor(texelsOf));
    return wrap == TextureWrap::Clamp && i >= size ? size - 1 : i;
}

/// Returns the texture's value on the face of a cube map that a direction points to [OpenGL21,
/// table 3.19].
Vec4 sampleCube(const Texture& texture, Vec3 r)
{
    const Vec3 a(std::fabs(r.x), std::fabs(r.y), std::fabs(r.z));
    int face;
    float s, t, largest;
    if (a.x >= a.y && a.x >= a.z)
        face = r.x >= 0.0f ? 0 : 1, s = r.x >= 0.0f ? -r.z : r.z, t = -r.y, largest = a.x;
    else if (a.y >= a.z)
        face = r.y >= 0.0f ? 2 : 3, s = r.x, t = r.y >= 0.0f ? r.z : -r.z, largest = a.y;
    else
        face = r.z >= 0.0f ? 4 : 5, s = r.z >= 0.0f ? r.x : -r.x, t = -r.y, largest = a.z;
    const float scale = largest > 0.0f && largest < kInfinity ? 0.5f / largest : 0.0f;
    const int size = texture.width;
    const auto inFace = [size](float coordinate)
    { return std::fmin(std::fmax(coordinate * float(size) - 0.5f, 0.0f), float(size - 1)); };
    const float x = inFace(s * scale + 0.5f), y = inFace(t * scale + 0.5f);
    const int bottom = face * size;
    if (!texture.linearFilter)
        return texel(texture, int(std::lround(x)), bottom + int(std::lround(y)));
    const int x0 = int(x), y0 = int(y), x1 = x0 + 1 < size ? x0 + 1 : x0,
              y1 = y0 + 1 < size ? y0 + 1 : y0;
    const float fx = x - float(x0), fy = y - float(y0);
    const Vec4 low = glm::mix(texel(texture, x0, bottom + y0), texel(texture, x1, bottom + y0), fx);
    const Vec4 high =
        glm::mix(texel(texture, x0, bottom + y1), texel(texture, x1, bottom + y1), fx);
    return glm::mix(low, high, fy);
}

/// Returns the filtered value within a slice.
Vec4 sampleSlice(const Texture& texture, Vec2 uv, int slice)
{
    const float x = texels(uv.x, texture.width, texture.wrapS);
    const float y = texels(uv.y, texture.height, texture.wrapT);
    if (!texture.linearFilter)
        return texel(texture, nearest(x, texture.width, texture.wrapS),
                     nearest(y, texture.height, texture.wrapT), slice);

    const float x0 = std::floor(x - 0.5f), y0 = std::floor(y - 0.5f);
    const float fx = x - 0.5f - x0, fy = y - 0.5f - y0;
    const int ix = static_cast<int>(x0), iy = static_cast<int>(y0);
    const Vec4 bottom =
        texel(texture, ix, iy, slice) * (1.0f - fx) + texel(texture, ix + 1, iy, slice) * fx;
    const Vec4 top = texel(texture, ix, iy + 1, slice) * (1.0f - fx) +
                     texel(texture, ix + 1, iy + 1, slice) * fx;
    return bottom * (1.0f - fy) + top * fy;
}

Vec4 sampleVolume(const Texture& texture, Vec3 str)
{
    const auto slice = [&](int z)
    {
        if (hasBorder(texture.wrapR) && (z < 0 || z >= texture.depth)) return borderOf(texture);
        return sampleSlice(texture, Vec2(str), wrapped(z, texture.depth, texture.wrapR));
    };
    const float z = texels(str.z, texture.depth, texture.wrapR);
    if (!texture.linearFilter) return slice(nearest(z, texture.depth, texture.wrapR));
    const float z0 = std::floor(z - 0.5f), fz = z - 0.5f - z0;
    const int iz = static_cast<int>(z0);
    return slice(iz) * (1.0f - fz) + slice(iz + 1) * fz;
}

/// The least and the largest byte of each channel.
struct ByteRange
{
    uint8_t least[4] = {255, 255, 255, 255}, largest[4] = {};
};

OSGRAYTRACE_KERNEL ByteRange rangeOf(const std::vector<uint8_t>& bytes)
{
    constexpr std::size_t kStripe = 64; // a whole number of texels, and of vectors
    uint8_t least[kStripe], largest[kStripe] = {};
    std::memset(least, 255, kStripe);
    const uint8_t* const all = bytes.data();
    const std::size_t whole = bytes.size() / kStripe * kStripe;
    for (std::size_t i = 0; i < whole; i += kStripe)
    {
        OSGRAYTRACE_SIMD
        for (std::size_t k = 0; k < kStripe; ++k)
        {
            const uint8_t byte = all[i + k];
            least[k] = byte < least[k] ? byte : least[k];
            largest[k] = byte > largest[k] ? byte : largest[k];
        }
    }
    for (std::size_t i = whole; i < bytes.size(); ++i)
    {
        least[i - whole] = std::min(least[i - whole], all[i]);
        largest[i - whole] = std::max(largest[i - whole], all[i]);
    }
    ByteRange range;
    for (std::size_t k = 0; k < kStripe; ++k)
    {
        range.least[k % 4] = std::min(range.least[k % 4], least[k]);
        range.largest[k % 4] = std::max(range.largest[k % 4], largest[k]);
    }
    return range;
}

/// Returns the value of a byte in a channel, 0: red to 3: alpha.
float valueOf(const Texture& texture, uint8_t byte, int channel)
{
    return texture.decodeSrgb && channel < 3 ? decodedBytes()[byte] : float(byte) * (1.0f / 255.0f);
}

} // namespace

Vec3 largestTexel(const Texture& texture)
{
    Vec3 largest(0.0f);
    if (hasBorder(texture.wrapS) || hasBorder(texture.wrapT))
        largest = glm::max(Vec3(borderOf(texture)), largest);
    for (std::size_t i = 0; i + 3 < texture.floats.size(); i += 4)
        for (int c = 0; c < 3; ++c)
            largest[c] = std::fmax(largest[c], texture.floats[i + std::size_t(c)]);
    const ByteRange range = rangeOf(texture.bytes);
    for (int c = 0; c < 3; ++c)
        largest[c] = std::fmax(largest[c], valueOf(texture, range.largest[c], c));
    return largest;
}

float leastTexel(const Texture& texture, int channel)
{
    float least = kInfinity;
    if (hasBorder(texture.wrapS) || hasBorder(texture.wrapT)) least = borderOf(texture)[channel];
    for (auto i = std::size_t(channel); i < texture.floats.size(); i += 4)
        least = std::fmin(least, texture.floats[i]);
    if (!texture.bytes.empty())
        least = std::fmin(least, valueOf(texture, rangeOf(texture.bytes).least[channel], channel));
    return least < kInfinity ? std::fmax(least, 0.0f) : 0.0f;
}

Vec4 sampleTexture(const Texture& texture, Vec2 uv)
{
    return sampleSlice(texture, uv, 0);
}

Vec4 sampleTexture(const Texture& texture, Vec4 coordinates)
{
    if (texture.cube) return sampleCube(texture, Vec3(coordinates));
    const float q = coordinates.w;
    if (texture.depth > 0)
        return sampleVolume(texture, q == 1.0f ? Vec3(coordinates) : Vec3(coordinates) / q);
    return sampleTexture(texture, q == 1.0f ? Vec2(coordinates) : Vec2(coordinates) / q);
}

MipChoice mipFor(const Texture& texture, float width)
{
    if (texture.mips.empty() || !(width > 0.0f)) return {};
    const float texels = float(texture.width) * float(texture.height);
    const float lod = 0.5f * std::log2(width * width * texels);
    if (!(lod > 0.0f)) return {};
    const int coarsest = static_cast<int>(texture.mips.size());
    if (lod >= float(coarsest)) return {coarsest, 0.0f};
    if (!texture.blendsMips) return {static_cast<int>(lod + 0.5f), 0.0f};
    const int level = static_cast<int>(lod);
    return {level, lod - float(level)};
}

Vec4 sampleTexture(const Texture& texture, Vec2 uv, float width)
{
    const MipChoice choice = mipFor(texture, width);
    const Vec4 value = sampleTexture(levelOf(texture, choice.level), uv);
    if (choice.share == 0.0f) return value;
    return glm::mix(value, sampleTexture(levelOf(texture, choice.level + 1), uv), choice.share);
}

Vec4 sampleTexture(const Texture& texture, Vec4 coordinates, float width)
{
    if (texture.mips.empty() || !(width > 0.0f)) return sampleTexture(texture, coordinates);
    return sampleTexture(texture, Vec2(coordinates) / coordinates.w, width);
}

} // namespace osgRayTrace::engine
