// TextureSample.cpp - looks a colour up in a texture. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/TextureSample.h"

#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Linear value of each sRGB byte [IEC61966].
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

/// Texel index in [0, size) of any integer position.
int wrapped(int i, int size, TextureWrap wrap)
{
    if (wrap == TextureWrap::ClampToEdge) return i < 0 ? 0 : i >= size ? size - 1 : i;
    const int period = wrap == TextureWrap::Mirror ? 2 * size : size;
    int m = i % period;
    if (m < 0) m += period;
    return m < size ? m : period - 1 - m;
}

Vec4 texel(const Texture& texture, int x, int y)
{
    const std::size_t at =
        4 * (static_cast<std::size_t>(wrapped(y, texture.height, texture.wrapT)) *
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

/// A coordinate in texels, within what an int holds; NaN becomes 0.
float texels(float coordinate, int size)
{
    const float value = coordinate * static_cast<float>(size);
    return std::fabs(value) < 1e9f ? value : 0.0f;
}

} // namespace

Vec4 sampleTexture(const Texture& texture, Vec2 uv)
{
    const float x = texels(uv.x, texture.width);
    const float y = texels(uv.y, texture.height);
    if (!texture.linearFilter)
        return texel(texture, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));

    const float x0 = std::floor(x - 0.5f), y0 = std::floor(y - 0.5f);
    const float fx = x - 0.5f - x0, fy = y - 0.5f - y0;
    const int ix = static_cast<int>(x0), iy = static_cast<int>(y0);
    const Vec4 bottom = texel(texture, ix, iy) * (1.0f - fx) + texel(texture, ix + 1, iy) * fx;
    const Vec4 top = texel(texture, ix, iy + 1) * (1.0f - fx) + texel(texture, ix + 1, iy + 1) * fx;
    return bottom * (1.0f - fy) + top * fy;
}

} // namespace osgRayTrace::engine
