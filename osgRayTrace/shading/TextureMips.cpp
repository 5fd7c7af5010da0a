// TextureMips.cpp - means over areas, in linear values. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/TextureMips.h"

#include "osgRayTrace/shading/TextureSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Holds RGBA of an image, linear.
struct Level
{
    int width = 0, height = 0;
    std::vector<float> values;
};

/// Holds the part of a row, or of a column, that a texel of the next level covers.
struct Span
{
    int first = 0, count = 1;
    float weights[4] = {1.0f};
};

/// Returns the parts of `from` texels that each of `to` texels covers; to is at least from/2,
/// rounded down.
std::vector<Span> spansOf(int from, int to)
{
    std::vector<Span> spans(static_cast<std::size_t>(to));
    const double length = double(from) / to;
    for (int i = 0; i < to; ++i)
    {
        Span& span = spans[static_cast<std::size_t>(i)];
        const double begin = i * length, end = std::min(begin + length, double(from));
        span.first = std::min(static_cast<int>(begin + 1e-9), from - 1);
        span.count = std::min(static_cast<int>(std::ceil(end - 1e-9)), from) - span.first;
        for (int k = 0; k < span.count; ++k)
        {
            const double low = std::max(begin, double(span.first + k));
            const double high = std::min(end, double(span.first + k + 1));
            span.weights[k] = static_cast<float>((high - low) / length);
        }
    }
    return spans;
}

/// Sets a row of linear values of an image of bytes or floats.
void readRow(const Texture& image, int y, std::vector<float>& row)
{
    const std::size_t length = 4 * static_cast<std::size_t>(image.width);
    const std::size_t begin = length * static_cast<std::size_t>(y);
    if (!image.floats.empty())
    {
        std::copy_n(image.floats.begin() + static_cast<std::ptrdiff_t>(begin), length, row.begin());
        return;
    }
    const std::array<float, 256>& linear = decodedBytes();
    for (std::size_t i = 0; i < length; ++i)
    {
        const uint8_t byte = image.bytes[begin + i];
        row[i] = image.decodeSrgb && i % 4 != 3 ? linear[byte] : byte * (1.0f / 255.0f);
    }
}

void readRow(const Level& level, int y, std::vector<float>& row)
{
    const std::size_t length = 4 * static_cast<std::size_t>(level.width);
    std::copy_n(level.values.begin() + static_cast<std::ptrdiff_t>(length) * y, length,
                row.begin());
}

/// Adds a row of means along x, times a weight, to sums.
void addNarrowed(const std::vector<float>& row, const std::vector<Span>& spans, float weight,
                 float* sums)
{
    for (const Span& span : spans)
    {
        const float* texel = &row[4 * static_cast<std::size_t>(span.first)];
        for (int k = 0; k < span.count; ++k, texel += 4)
        {
            const float share = weight * span.weights[k];
            for (int c = 0; c < 4; ++c)
                sums[c] += share * texel[c];
        }
        sums += 4;
    }
}

/// Returns the level after an image, which is a Texture or a Level.
template <class Image> Level halved(const Image& image)
{
    Level next;
    next.width = std::max(1, image.width / 2);
    next.height = std::max(1, image.height / 2);
    const std::size_t length = 4 * static_cast<std::size_t>(next.width);
    next.values.assign(length * static_cast<std::size_t>(next.height), 0.0f);
    const std::vector<Span> columns = spansOf(image.width, next.width);
    const std::vector<Span> rows = spansOf(image.height, next.height);
    std::vector<float> row(4 * static_cast<std::size_t>(image.width));
    for (std::size_t y = 0; y < rows.size(); ++y)
        for (int k = 0; k < rows[y].count; ++k)
        {
            readRow(image, rows[y].first + k, row);
            addNarrowed(row, columns, rows[y].weights[k], &next.values[length * y]);
        }
    return next;
}

/// Returns the byte whose linear value is nearest; the table of decoded values is the scale.
uint8_t encodedByte(float linear)
{
    const std::array<float, 256>& table = decodedBytes();
    const auto above = std::lower_bound(table.begin(), table.end(), linear);
    if (above == table.begin()) return 0;
    if (above == table.end()) return 255;
    const auto index = above - table.begin();
    const bool isLower = linear - above[-1] < *above - linear;
    return static_cast<uint8_t>(isLower ? index - 1 : index);
}

std::vector<uint8_t> bytesOf(const Level& level, bool encode)
{
    std::vector<uint8_t> bytes(level.values.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        const float value = std::clamp(level.values[i], 0.0f, 1.0f);
        bytes[i] =
            encode && i % 4 != 3 ? encodedByte(value) : static_cast<uint8_t>(value * 255.0f + 0.5f);
    }
    return bytes;
}

/// Returns the texture of a level, which wraps and is decoded as the image.
Texture textureOf(const Texture& image, const Level& level, bool linearFilter)
{
    Texture mip;
    mip.width = level.width;
    mip.height = level.height;
    mip.hasColor = image.hasColor;
    mip.hasAlpha = image.hasAlpha;
    mip.opaque = image.opaque;
    mip.border = image.border;
    mip.decodeSrgb = image.decodeSrgb;
    mip.linearFilter = linearFilter;
    mip.wrapS = image.wrapS;
    mip.wrapT = image.wrapT;
    if (image.floats.empty())
        mip.bytes = bytesOf(level, image.decodeSrgb);
    else
        mip.floats = level.values;
    return mip;
}

} // namespace

std::vector<Texture> textureMips(const Texture& image, bool linearFilter)
{
    std::vector<Texture> mips;
    if (image.width <= 1 && image.height <= 1) return mips;
    for (Level level = halved(image);; level = halved(level))
    {
        mips.push_back(textureOf(image, level, linearFilter));
        if (level.width == 1 && level.height == 1) return mips;
    }
}

} // namespace osgRayTrace::engine
