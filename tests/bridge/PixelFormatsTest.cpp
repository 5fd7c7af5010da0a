// PixelFormatsTest.cpp - decoding of pixel formats, rows and compressed blocks.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/PixelDecoder.h"
#include "tests/Catch.h"
#include "tests/bridge/TexturedGraphs.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

std::vector<uint8_t> bytesOf(const osg::Image& image)
{
    Texture texture;
    REQUIRE(decodePixels(image, texture));
    CHECK(texture.floats.empty());
    return texture.bytes;
}

std::vector<float> floatsOf(const osg::Image& image)
{
    Texture texture;
    REQUIRE(decodePixels(image, texture));
    CHECK(texture.bytes.empty());
    return texture.floats;
}

} // namespace

TEST_CASE("8-bit formats decode to RGBA bytes", "[bridge]")
{
    const auto decode = [](GLenum format, const Bytes& pixel)
    { return bytesOf(*imageOf<uint8_t>(1, 1, format, GL_UNSIGNED_BYTE, pixel)); };
    CHECK(decode(GL_RGBA, {1, 2, 3, 4}) == Bytes{1, 2, 3, 4});
    CHECK(decode(GL_BGRA, {1, 2, 3, 4}) == Bytes{3, 2, 1, 4});
    CHECK(decode(GL_RGB, {1, 2, 3}) == Bytes{1, 2, 3, 255});
    CHECK(decode(GL_BGR, {1, 2, 3}) == Bytes{3, 2, 1, 255});
    CHECK(decode(GL_LUMINANCE, {7}) == Bytes{7, 7, 7, 255});
    CHECK(decode(GL_LUMINANCE_ALPHA, {7, 8}) == Bytes{7, 7, 7, 8});
    CHECK(decode(GL_INTENSITY, {7}) == Bytes{7, 7, 7, 7});
    CHECK(decode(GL_ALPHA, {9}) == Bytes{255, 255, 255, 9});
    CHECK(decode(GL_RED, {5}) == Bytes{5, 0, 0, 255});
    CHECK(decode(GL_RG, {5, 6}) == Bytes{5, 6, 0, 255});
}

TEST_CASE("wide formats decode to floats, what is not finite to 0", "[bridge]")
{
    CHECK(floatsOf(*imageOf<uint16_t>(1, 1, GL_RG, GL_UNSIGNED_SHORT, {65535, 0})) ==
          Floats{1, 0, 0, 1});
    CHECK(floatsOf(*imageOf<uint16_t>(1, 1, GL_LUMINANCE, GL_HALF_FLOAT, {0x3e00})) ==
          Floats{1.5f, 1.5f, 1.5f, 1});
    const float inf = std::numeric_limits<float>::infinity();
    CHECK(floatsOf(*imageOf<float>(1, 1, GL_RGBA, GL_FLOAT, {-2.0f, inf, 1e6f, 0.5f})) ==
          Floats{-2, 0, 1e6f, 0.5f});
    CHECK(floatsOf(*imageOf<int16_t>(1, 1, GL_RED, GL_SHORT, {32767})) == Floats{1, 0, 0, 1});
}

TEST_CASE("rows: packing and row length; the first in memory is the lowest, whatever the origin",
          "[bridge]")
{
    // A row of 3 RGB pixels has 9 bytes, which are padded to 12.
    const Bytes rows{1, 1, 1, 2, 2, 2, 3, 3, 3, 0, 0, 0, 4, 4, 4, 5, 5, 5, 6, 6, 6};
    const auto image = imageOf<uint8_t>(3, 2, GL_RGB, GL_UNSIGNED_BYTE, rows, 4);
    const Bytes expected{1, 1, 1, 255, 2, 2, 2, 255, 3, 3, 3, 255,
                         4, 4, 4, 255, 5, 5, 5, 255, 6, 6, 6, 255};
    CHECK(bytesOf(*image) == expected);
    image->setOrigin(osg::Image::TOP_LEFT);
    CHECK(bytesOf(*image) == expected);

    static unsigned char wide[] = {1, 2, 9, 9, 3, 4, 9, 9};
    osg::ref_ptr<osg::Image> part = new osg::Image;
    part->setImage(2, 2, 1, GL_LUMINANCE, GL_LUMINANCE, GL_UNSIGNED_BYTE, wide,
                   osg::Image::NO_DELETE, 1, 4);
    CHECK(bytesOf(*part) == Bytes{1, 1, 1, 255, 2, 2, 2, 255, 3, 3, 3, 255, 4, 4, 4, 255});
}

TEST_CASE("DXT blocks decode", "[bridge]")
{
    // DXT1: both end points are white (0xffff), or the first colour of a block of index 0 is red
    // (0xf800).
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_UNSIGNED_BYTE);
    const uint8_t block[8] = {0x00, 0xf8, 0x00, 0x00, 0, 0, 0, 0};
    std::memcpy(image->data(), block, sizeof block);
    const Bytes pixels = bytesOf(*image);
    REQUIRE(pixels.size() == 64);
    for (std::size_t i = 0; i < 64; i += 4)
        CHECK(Bytes(pixels.begin() + i, pixels.begin() + i + 4) == Bytes{255, 0, 0, 255});
}

namespace
{

/// Returns a 4x4 image of one block.
osg::ref_ptr<osg::Image> blockImage(GLenum format, const Bytes& block)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, format, GL_UNSIGNED_BYTE);
    REQUIRE(image->getTotalSizeInBytes() == block.size());
    std::memcpy(image->data(), block.data(), block.size());
    return image;
}

/// The codes 0 to 7 come twice, in three bits each.
const Bytes kAllCodes{0x88, 0xc6, 0xfa, 0x88, 0xc6, 0xfa};

Bytes joined(const Bytes& a, const Bytes& b)
{
    Bytes both(a.size() + b.size());
    std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), both.begin()));
    return both;
}

Bytes channelBlock(uint8_t first, uint8_t second)
{
    return joined({first, second}, kAllCodes);
}

} // namespace

TEST_CASE("block formats: every code of every mode, by the specification", "[bridge]")
{
    const auto channel = [](const Bytes& pixels, int c)
    {
        Bytes values;
        for (std::size_t i = 0; i < 8; ++i)
            values.push_back(pixels[4 * i + std::size_t(c)]);
        return values;
    };
    // The eight values go from 210 to 0 in sevenths. The six go in fifths and are followed by 0 and
    // 1.
    const Bytes eight{210, 0, 180, 150, 120, 90, 60, 30}, six{0, 200, 40, 80, 120, 160, 0, 255};
    const Bytes rgtc1 = bytesOf(*blockImage(GL_COMPRESSED_RED_RGTC1_EXT, channelBlock(210, 0)));
    CHECK(channel(rgtc1, 0) == eight);
    CHECK(channel(rgtc1, 1) == Bytes(8, 0));
    CHECK(channel(rgtc1, 3) == Bytes(8, 255));
    CHECK(channel(bytesOf(*blockImage(GL_COMPRESSED_RED_RGTC1_EXT, channelBlock(0, 200))), 0) ==
          six);

    const Bytes two = joined(channelBlock(210, 0), channelBlock(0, 200));
    const Bytes rgtc2 = bytesOf(*blockImage(GL_COMPRESSED_RED_GREEN_RGTC2_EXT, two));
    CHECK(channel(rgtc2, 0) == eight);
    CHECK(channel(rgtc2, 1) == six);

    const Floats signedValues =
        floatsOf(*blockImage(GL_COMPRESSED_SIGNED_RED_RGTC1_EXT, channelBlock(0x81, 0x7f)));
    const float expected[] = {-1.0f, 1.0f, -0.6f, -0.2f, 0.2f, 0.6f, -1.0f, 1.0f};
    for (std::size_t i = 0; i < 8; ++i)
        CHECK(signedValues[4 * i] == Approx(expected[i]).margin(1e-6));

    // The first row has the codes 0 to 3; red 0xf800 is the larger end point 0 in the one block and
    // end point 1 in the other.
    const auto colors = [](GLenum format, Bytes block)
    {
        const Bytes pixels = bytesOf(*blockImage(format, block));
        return Bytes(pixels.begin(), pixels.begin() + 16);
    };
    const Bytes four{0x00, 0xf8, 0x1f, 0x00, 0xe4, 0xe4, 0xe4, 0xe4},
        three{0x1f, 0x00, 0x00, 0xf8, 0xe4, 0xe4, 0xe4, 0xe4};
    CHECK(colors(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, four) ==
          Bytes{255, 0, 0, 255, 0, 0, 255, 255, 170, 0, 85, 255, 85, 0, 170, 255});
    CHECK(colors(GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, three) ==
          Bytes{0, 0, 255, 255, 255, 0, 0, 255, 128, 0, 128, 255, 0, 0, 0, 0});
    CHECK(colors(GL_COMPRESSED_RGB_S3TC_DXT1_EXT, three)[15] == 255);

    // DXT3 has no three-colour code.
    const Bytes dxt3 = joined({0x10, 0x32, 0x10, 0x32, 0x10, 0x32, 0x10, 0x32}, three);
    CHECK(colors(GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, dxt3) ==
          Bytes{0, 0, 255, 0, 255, 0, 0, 17, 85, 0, 170, 34, 170, 0, 85, 51});
    const Bytes dxt5 = joined(channelBlock(210, 0), four);
    CHECK(channel(bytesOf(*blockImage(GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, dxt5)), 3) == eight);
}

TEST_CASE("packed formats: bits in OpenGL's order", "[bridge]")
{
    const auto pixel16 = [](GLenum format, GLenum type, uint16_t value)
    { return bytesOf(*imageOf<uint16_t>(1, 1, format, type, {value})); };
    CHECK(pixel16(GL_RGB, GL_UNSIGNED_SHORT_5_6_5, 0xf800) == Bytes{255, 0, 0, 255});
    CHECK(pixel16(GL_RGB, GL_UNSIGNED_SHORT_5_6_5_REV, 0xf800) == Bytes{0, 0, 255, 255});
    CHECK(pixel16(GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, 0xf731) == Bytes{255, 119, 51, 17});
    CHECK(pixel16(GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4_REV, 0xf731) == Bytes{17, 51, 119, 255});
    CHECK(pixel16(GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV, 0x7c00) == Bytes{255, 0, 0, 0});
    CHECK(pixel16(GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, 0xf801) == Bytes{255, 0, 0, 255});
    const auto pixel32 = [](GLenum format, GLenum type, uint32_t value)
    { return imageOf<uint32_t>(1, 1, format, type, {value}); };
    CHECK(bytesOf(*pixel32(GL_RGBA, GL_UNSIGNED_INT_8_8_8_8, 0x01020304)) == Bytes{1, 2, 3, 4});
    CHECK(bytesOf(*pixel32(GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, 0x01020304)) == Bytes{4, 3, 2, 1});
    CHECK(bytesOf(*pixel32(GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, 0x400003ff)) ==
          Bytes{255, 0, 0, 85});
    CHECK(bytesOf(*imageOf<uint8_t>(1, 1, GL_RGB, GL_UNSIGNED_BYTE_3_3_2, {0xe1})) ==
          Bytes{255, 0, 85, 255});
}
