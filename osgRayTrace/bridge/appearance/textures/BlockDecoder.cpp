// BlockDecoder.cpp - decodes block-compressed images: DXT1, DXT3, DXT5 and RGTC. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/BlockDecoder.h"

#include <osg/Texture>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kBlock = 4; ///< texels along a side of a block

/// Holds the sixteen texels of a block, row by row.
struct BlockColors
{
    float rgba[kBlock * kBlock][4] = {};
};

uint32_t littleEndian(const uint8_t* bytes, int count)
{
    uint32_t value = 0;
    for (int i = count - 1; i >= 0; --i)
        value = value << 8 | bytes[i];
    return value;
}

void unpack565(uint32_t packed, float* rgb)
{
    rgb[0] = static_cast<float>(packed >> 11 & 31u) / 31.0f;
    rgb[1] = static_cast<float>(packed >> 5 & 63u) / 63.0f;
    rgb[2] = static_cast<float>(packed & 31u) / 31.0f;
}

/// Decodes the colours of a block [EXTs3tc, sect. 3.8.3]. Only DXT1 has the three-colour code,
/// whose last value is black, and transparent if the format has alpha.
void decodeColors(const uint8_t* bytes, bool dxt1, bool transparentBlack, BlockColors& block)
{
    const uint32_t packed0 = littleEndian(bytes, 2), packed1 = littleEndian(bytes + 2, 2);
    float palette[4][4] = {};
    unpack565(packed0, palette[0]);
    unpack565(packed1, palette[1]);
    const bool four = !dxt1 || packed0 > packed1;
    for (int c = 0; c < 3; ++c)
    {
        const float a = palette[0][c], b = palette[1][c];
        palette[2][c] = four ? (2.0f * a + b) / 3.0f : 0.5f * (a + b);
        palette[3][c] = four ? (a + 2.0f * b) / 3.0f : 0.0f;
    }
    for (int i = 0; i < 4; ++i)
        palette[i][3] = i == 3 && !four && transparentBlack ? 0.0f : 1.0f;
    const uint32_t codes = littleEndian(bytes + 4, 4);
    for (int i = 0; i < kBlock * kBlock; ++i)
        std::copy_n(palette[codes >> 2 * i & 3u], 4, block.rgba[i]);
}

/// Decodes sixteen values from two end points and codes of three bits: the alpha of DXT5 and the
/// channels of RGTC [ARBrgtc].
void decodeChannel(const uint8_t* bytes, bool isSigned, int channel, BlockColors& block)
{
    const auto endPoint = [isSigned](uint8_t byte)
    {
        if (!isSigned) return static_cast<float>(byte) / 255.0f;
        return static_cast<float>(std::max(-127, static_cast<int>(static_cast<int8_t>(byte)))) /
               127.0f;
    };
    const float a = endPoint(bytes[0]), b = endPoint(bytes[1]);
    const bool eight = isSigned ? static_cast<int8_t>(bytes[0]) > static_cast<int8_t>(bytes[1])
                                : bytes[0] > bytes[1];
    float palette[8] = {a, b};
    const int steps = eight ? 7 : 5;
    for (int i = 1; i < steps; ++i)
        palette[i + 1] = (static_cast<float>(steps - i) * a + static_cast<float>(i) * b) /
                         static_cast<float>(steps);
    if (!eight)
    {
        palette[6] = isSigned ? -1.0f : 0.0f;
        palette[7] = 1.0f;
    }
    uint64_t codes = 0;
    for (int i = 5; i >= 0; --i)
        codes = codes << 8 | bytes[2 + i];
    for (int i = 0; i < kBlock * kBlock; ++i)
        block.rgba[i][channel] = palette[codes >> 3 * i & 7u];
}

void decodeFourBitAlpha(const uint8_t* bytes, BlockColors& block)
{
    for (int i = 0; i < kBlock * kBlock; ++i)
        block.rgba[i][3] = static_cast<float>(bytes[i / 2] >> 4 * (i % 2) & 15u) / 15.0f;
}

/// Returns the bytes of a block; 0 for all other formats.
int blockSize(GLenum format)
{
    switch (format)
    {
    case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
    case GL_COMPRESSED_RGBA_S3TC_DXT1_EXT:
    case GL_COMPRESSED_RED_RGTC1_EXT:
    case GL_COMPRESSED_SIGNED_RED_RGTC1_EXT:
        return 8;
    case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
    case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT:
    case GL_COMPRESSED_RED_GREEN_RGTC2_EXT:
    case GL_COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT:
        return 16;
    default:
        return 0;
    }
}

bool isSignedFormat(GLenum format)
{
    return format == GL_COMPRESSED_SIGNED_RED_RGTC1_EXT ||
           format == GL_COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT;
}

BlockColors decodeBlock(GLenum format, const uint8_t* bytes)
{
    BlockColors block;
    for (auto& texel : block.rgba)
        texel[3] = 1.0f;
    switch (format)
    {
    case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
        decodeColors(bytes, true, false, block);
        break;
    case GL_COMPRESSED_RGBA_S3TC_DXT1_EXT:
        decodeColors(bytes, true, true, block);
        break;
    case GL_COMPRESSED_RGBA_S3TC_DXT3_EXT:
        decodeColors(bytes + 8, false, false, block);
        decodeFourBitAlpha(bytes, block);
        break;
    case GL_COMPRESSED_RGBA_S3TC_DXT5_EXT:
        decodeColors(bytes + 8, false, false, block);
        decodeChannel(bytes, false, 3, block);
        break;
    case GL_COMPRESSED_RED_GREEN_RGTC2_EXT:
    case GL_COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT:
        decodeChannel(bytes + 8, isSignedFormat(format), 1, block);
        decodeChannel(bytes, isSignedFormat(format), 0, block);
        break;
    default:
        decodeChannel(bytes, isSignedFormat(format), 0, block);
    }
    return block;
}

template <class Value, class Convert>
void store(const osg::Image& image, int bytesPerBlock, const Convert& convert,
           std::vector<Value>& out)
{
    const GLenum format = image.getPixelFormat();
    const int width = image.s(), height = image.t();
    const int columns = (width + kBlock - 1) / kBlock, rows = (height + kBlock - 1) / kBlock;
    out.resize(static_cast<std::size_t>(width) * height * 4);
    const uint8_t* source = image.data();
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column, source += bytesPerBlock)
        {
            const BlockColors block = decodeBlock(format, source);
            for (int i = 0; i < kBlock * kBlock; ++i)
            {
                const int x = column * kBlock + i % kBlock, y = row * kBlock + i / kBlock;
                if (x >= width || y >= height) continue;
                for (int c = 0; c < 4; ++c)
                    out[4 * (static_cast<std::size_t>(y) * width + x) + c] =
                        convert(block.rgba[i][c]);
            }
        }
}

} // namespace

bool decodeBlocks(const osg::Image& image, Texture& texture)
{
    const int bytes = blockSize(image.getPixelFormat());
    const std::size_t blocks = std::size_t((image.s() + 3) / kBlock) * ((image.t() + 3) / kBlock);
    if (bytes == 0 || image.getTotalSizeInBytes() < blocks * bytes) return false;
    if (isSignedFormat(image.getPixelFormat()))
        store(
            image, bytes, [](float value) { return value; }, texture.floats);
    else
        store(
            image, bytes,
            [](float value) { return static_cast<uint8_t>(std::lround(255.0f * value)); },
            texture.bytes);
    return true;
}

} // namespace osgRayTrace::engine
