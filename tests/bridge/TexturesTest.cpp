// TexturesTest.cpp - pixel formats, texture state and textures that are not sampled.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/PixelDecoder.h"
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/ColorMask>
#include <osg/FragmentProgram>
#include <osg/Program>
#include <osg/Stencil>
#include <osg/TexEnv>
#include <osg/TexEnvCombine>
#include <osg/TexGen>
#include <osg/TexMat>
#include <osg/Texture2D>
#include <osg/Texture3D>
#include <osg/TextureCubeMap>

#include <algorithm>
#include <cstring>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr auto kOn = osg::StateAttribute::ON;

/// Returns an image that owns a copy of the values.
template <class Scalar>
osg::ref_ptr<osg::Image> imageOf(int width, int height, GLenum format, GLenum type,
                                 const std::vector<Scalar>& values, int packing = 1)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type, packing);
    REQUIRE(image->getTotalSizeInBytes() >= values.size() * sizeof(Scalar));
    std::memcpy(image->data(), values.data(), values.size() * sizeof(Scalar));
    return image;
}

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

using Bytes = std::vector<uint8_t>;
using Floats = std::vector<float>;

osg::ref_ptr<osg::Texture2D> smallTexture()
{
    osg::ref_ptr<osg::Texture2D> texture =
        new osg::Texture2D(imageOf<uint8_t>(1, 1, GL_RGB, GL_UNSIGNED_BYTE, {10, 20, 30}));
    texture->setName("small");
    return texture;
}

osg::ref_ptr<osg::Geometry> texturedGeometry(osg::StateAttribute* texture)
{
    const auto geometry = triangleGeometry();
    geometry->setTexCoordArray(0, new osg::Vec2Array(3));
    geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture, kOn);
    return geometry;
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

TEST_CASE("texture unit 0: attribute, mode, filter, wrap and environment", "[bridge]")
{
    const auto texture = smallTexture();
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::MIRROR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    const auto geometry = texturedGeometry(texture);
    osg::StateSet* state = geometry->getStateSet();

    ConversionResult result = convertGraph(geometry);
    REQUIRE(soleMaterial(result).baseColorTexture == 0);
    const Texture& converted = *result.scene->textures.at(0);
    CHECK(converted.name == "small");
    CHECK(converted.bytes == Bytes{10, 20, 30, 255});
    CHECK(converted.wrapS == TextureWrap::Repeat);
    CHECK(converted.wrapT == TextureWrap::Mirror);
    CHECK_FALSE(converted.linearFilter);
    CHECK_FALSE(converted.decodeSrgb);
    CHECK(soleMaterial(result).textureEnvironment == TextureEnvironment::Modulate);

    state->setTextureAttribute(0, new osg::TexEnv(osg::TexEnv::REPLACE));
    CHECK(soleMaterial(convertGraph(geometry)).textureEnvironment == TextureEnvironment::Replace);
    state->setTextureAttribute(0, new osg::TexEnv(osg::TexEnv::DECAL));
    CHECK(soleMaterial(convertGraph(geometry)).textureEnvironment == TextureEnvironment::Decal);
    state->setTextureAttribute(0, new osg::TexEnvCombine);
    result = convertGraph(geometry);
    CHECK(soleMaterial(result).textureEnvironment == TextureEnvironment::Modulate);
    CHECK(countOf(result, "approximated.texture-environment") == 1);

    state->setTextureMode(0, GL_TEXTURE_2D, osg::StateAttribute::OFF);
    result = convertGraph(geometry);
    CHECK(soleMaterial(result).baseColorTexture == kInvalid);
    CHECK(result.scene->textures.empty());
}

TEST_CASE("textures that cannot be sampled are left out and counted", "[bridge]")
{
    SECTION("no image on the CPU")
    {
        const ConversionResult result = convertGraph(texturedGeometry(new osg::Texture2D));
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-without-image") == 1);
    }
    SECTION("an image whose file was not read")
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->setFileName("bricks.png"); // as osgDB leaves the image
        const ConversionResult result = convertGraph(texturedGeometry(new osg::Texture2D(image)));
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-without-image") == 0);
        CHECK(countOf(result, "missing.texture-image") == 1);
        const auto& files = result.paths.at("missing.texture-image");
        REQUIRE(files.size() == 1);
        CHECK(files[0].find("bricks.png, for ") == 0);
    }
    SECTION("but one without coordinates is looked up at the corner, as in OpenGL")
    {
        const auto geometry = texturedGeometry(smallTexture());
        geometry->setTexCoordArray(0, nullptr);
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMaterial(result).baseColorTexture == 0);
        CHECK(soleMesh(result).uvs.empty());
    }
    SECTION("generated coordinates that nothing generates")
    {
        const auto geometry = texturedGeometry(smallTexture());
        geometry->getStateSet()->setTextureMode(0, GL_TEXTURE_GEN_S, kOn);
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.no-texture-coordinates") == 1);
    }
    SECTION("a cube without faces")
    {
        const ConversionResult result = convertGraph(texturedGeometry(new osg::TextureCubeMap));
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-without-image") == 1);
    }
    SECTION("higher units")
    {
        const auto geometry = triangleGeometry();
        geometry->getOrCreateStateSet()->setTextureAttributeAndModes(2, smallTexture(), kOn);
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMaterial(result).baseColorTexture == kInvalid);
        CHECK(countOf(result, "approximated.texture-unit") == 1);
    }
    SECTION("an unknown pixel format is magenta")
    {
        const auto wrong = imageOf<uint16_t>(1, 1, GL_RGBA, GL_UNSIGNED_SHORT_5_6_5, {0});
        const ConversionResult result = convertGraph(texturedGeometry(new osg::Texture2D(wrong)));
        CHECK(countOf(result, "approximated.pixel-format") == 1);
        REQUIRE(soleMaterial(result).baseColorTexture == 0);
        CHECK(result.scene->textures[0]->bytes == Bytes{255, 0, 255, 255});
    }
}

TEST_CASE("textures of a linear scene: colours are decoded, data and floats are not", "[bridge]")
{
    osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    const auto color = smallTexture();
    physical->setBaseColorTexture(color);
    physical->setMetallicRoughnessTexture(color);
    physical->setEmissionTexture(color);
    osg::ref_ptr<osg::Texture2D> wide =
        new osg::Texture2D(imageOf<float>(1, 1, GL_RED, GL_FLOAT, {0.5f}));
    physical->setTransmissionTexture(wide);
    const auto geometry = triangleGeometry();
    geometry->setTexCoordArray(0, new osg::Vec2Array(3));
    geometry->getOrCreateStateSet()->setAttribute(physical);

    const ConversionResult result = convertGraph(geometry);
    const Material& material = soleMaterial(result);
    const auto& textures = result.scene->textures;
    REQUIRE(textures.size() == 3);
    CHECK(textures.at(material.baseColorTexture)->decodeSrgb);
    CHECK(material.emissionTexture == material.baseColorTexture);
    CHECK_FALSE(textures.at(material.metallicRoughnessTexture)->decodeSrgb);
    CHECK_FALSE(textures.at(material.transmissionTexture)->decodeSrgb);
    CHECK(textures.at(material.transmissionTexture)->floats == Floats{0.5f, 0, 0, 1});
}

TEST_CASE("a texture whose image was given up stays what its image's format made of it", "[bridge]")
{
    const auto image = imageOf<uint8_t>(1, 1, GL_RGB, GL_UNSIGNED_BYTE, {10, 20, 30});
    image->setInternalTextureFormat(GL_SRGB8);
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    const auto geometry = texturedGeometry(texture);
    SceneConverter converter;
    CHECK(converter.convert(inputFor(geometry)).scene->textures.at(0)->decodeSrgb);
    texture->setImage(nullptr);
    const ConversionResult result = converter.convert(inputFor(geometry));
    REQUIRE(soleMaterial(result).baseColorTexture == 0);
    CHECK(result.scene->textures.at(0)->decodeSrgb);
    CHECK(result.scene->textures.at(0)->bytes == Bytes{10, 20, 30, 255});
}

TEST_CASE("texture modes that compress: the base format is OpenGL's", "[bridge]")
{
    const auto converted = [](osg::Texture::InternalFormatMode mode)
    {
        const osg::ref_ptr<osg::Texture2D> texture =
            new osg::Texture2D(imageOf<uint8_t>(1, 1, GL_RGBA, GL_UNSIGNED_BYTE, {10, 20, 30, 40}));
        texture->setInternalFormatMode(mode);
        return convertGraph(texturedGeometry(texture)).scene->textures.at(0)->bytes;
    };
    CHECK(converted(osg::Texture::USE_S3TC_DXT1_COMPRESSION) == Bytes{10, 20, 30, 40});
    CHECK(converted(osg::Texture::USE_S3TC_DXT5_COMPRESSION) == Bytes{10, 20, 30, 40});
    CHECK(converted(osg::Texture::USE_S3TC_DXT1c_COMPRESSION) == Bytes{10, 20, 30, 255});
}

TEST_CASE("3-D textures: all slices, and the third coordinate of the mesh", "[bridge]")
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 2, 3, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 6; ++i)
        *image->data(0, i % 2, i / 2) = static_cast<unsigned char>(10 * i);
    const osg::ref_ptr<osg::Texture3D> volume = new osg::Texture3D(image);
    volume->setWrap(osg::Texture::WRAP_R, osg::Texture::MIRROR);
    const auto geometry = texturedGeometry(volume);
    const osg::ref_ptr<osg::Vec3Array> coordinates = new osg::Vec3Array(3);
    (*coordinates)[1] = osg::Vec3(1, 2, 3);
    geometry->setTexCoordArray(0, coordinates);
    SceneConverter converter;
    ConversionResult result = converter.convert(inputFor(geometry));
    const Texture& texture = *result.scene->textures.at(0);
    CHECK((texture.width == 1 && texture.height == 2 && texture.depth == 3));
    REQUIRE(texture.bytes.size() == 24);
    CHECK(texture.bytes[4 * 5] == 50);
    CHECK(texture.wrapR == TextureWrap::Mirror);
    CHECK(soleMesh(result).uvs[1] == Vec2(1, 2));
    REQUIRE(soleMesh(result).rs.size() == 3);
    CHECK(soleMesh(result).rs[1] == 3);
    CHECK(soleMesh(result).rs1.empty());

    volume->setWrap(osg::Texture::WRAP_R, osg::Texture::REPEAT);
    result = converter.convert(inputFor(geometry));
    CHECK(result.scene->textures.at(0)->wrapR == TextureWrap::Repeat);
    // Homogeneous coordinates are divided; if r is 0 throughout, the mesh has no third coordinates.
    const osg::ref_ptr<osg::Vec4Array> projective = new osg::Vec4Array(3);
    (*projective)[0].set(0, 0, 6, 2);
    (*projective)[1].w() = (*projective)[2].w() = 1;
    geometry->setTexCoordArray(0, projective);
    CHECK(soleMesh(converter.convert(inputFor(geometry))).rs[0] == 3);
    (*projective)[0].z() = 0;
    projective->dirty();
    CHECK(soleMesh(converter.convert(inputFor(geometry))).rs.empty());
}

namespace
{

/// Converts as for a viewer, which draws the rest with OpenGL.
ConversionResult convertForViewer(SceneConverter& converter, osg::Node* root)
{
    ConversionInput input = inputFor(root);
    input.rasterizesRest = true;
    return converter.convert(input);
}

ConversionResult convertForViewer(osg::Node* root)
{
    SceneConverter converter;
    return convertForViewer(converter, root);
}

struct Filler : osg::Texture2D::SubloadCallback
{
    void load(const osg::Texture2D&, osg::State&) const override {}
    void subload(const osg::Texture2D&, osg::State&) const override {}
};

} // namespace

TEST_CASE("textures that only OpenGL has leave their geometry to it", "[bridge]")
{
    const char* const reason = "rasterized.texture-without-image";
    const auto rendered = []
    {
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setTextureSize(64, 64);
        texture->setInternalFormat(GL_RGBA);
        return texture;
    };
    SECTION("a camera's")
    {
        const auto root = texturedGeometry(rendered());
        const ConversionResult result = convertForViewer(root);
        CHECK(countOf(result, reason) == 1);
        CHECK(result.rasterized);
        CHECK(countOf(result, "converted.geometry") == 0);
        CHECK(countOf(convertGraph(root), "approximated.texture-without-image") == 1);
    }
    SECTION("in unit 1, too; not if it is off, or the file of an image is missing")
    {
        const auto root = texturedGeometry(smallTexture());
        root->getStateSet()->setTextureAttributeAndModes(1, rendered(), kOn);
        CHECK(countOf(convertForViewer(root), reason) == 1);
        root->getStateSet()->setTextureMode(1, GL_TEXTURE_2D, osg::StateAttribute::OFF);
        CHECK(countOf(convertForViewer(root), reason) == 0);
        CHECK(convertForViewer(texturedGeometry(new osg::Texture2D)).scene->instances.size() == 1);
    }
    SECTION("what a callback fills")
    {
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setSubloadCallback(new Filler);
        CHECK(countOf(convertForViewer(texturedGeometry(texture)), reason) == 1);
    }
    SECTION("not what was converted before its image was given up")
    {
        const auto texture = smallTexture();
        const auto root = texturedGeometry(texture);
        SceneConverter converter;
        convertForViewer(converter, root);
        texture->setImage(nullptr);
        texture->setTextureSize(1, 1); // as OSG records it on upload
        const ConversionResult result = convertForViewer(converter, root);
        CHECK(countOf(result, reason) == 0);
        CHECK(soleMaterial(result).baseColorTexture == 0);
        CHECK(countOf(convertForViewer(root), reason) == 1);
    }
}

namespace
{

/// A program of another class, as virtual programs are: it holds shaders in a way of its own.
struct VirtualProgram : osg::Program
{
    META_StateAttribute(test, VirtualProgram, PROGRAM)
    VirtualProgram() = default;
    VirtualProgram(const VirtualProgram& other, const osg::CopyOp& copy) : osg::Program(other, copy)
    {
    }
};

struct OtherProgram : osg::StateAttribute
{
    META_StateAttribute(test, OtherProgram, PROGRAM)
    OtherProgram() = default;
    OtherProgram(const OtherProgram& other, const osg::CopyOp& copy)
        : osg::StateAttribute(other, copy)
    {
    }
    int compare(const osg::StateAttribute& other) const override { return &other == this ? 0 : 1; }
};

} // namespace

TEST_CASE("programs of any class, stencils and colour masks leave their geometry to OpenGL",
          "[bridge]")
{
    const auto counted = [](const osg::ref_ptr<osg::Geometry>& geometry, const std::string& what)
    {
        const ConversionResult result = convertForViewer(geometry);
        CHECK((countOf(result, "converted.geometry") == 1) ==
              (countOf(result, "rasterized." + what) == 0));
        return countOf(result, "rasterized." + what);
    };
    const auto geometry = triangleGeometry();
    osg::StateSet& state = *geometry->getOrCreateStateSet();
    SECTION("programs")
    {
        CHECK(counted(geometry, "shader-program") == 0);
        state.setAttribute(new osg::Program); // without shaders: the fixed function
        CHECK(counted(geometry, "shader-program") == 0);
        state.setAttribute(new VirtualProgram);
        CHECK(counted(geometry, "shader-program") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.shader") == 1);
        state.setAttribute(new OtherProgram);
        CHECK(counted(geometry, "shader-program") == 1);
    }
    SECTION("ARB's programs")
    {
        state.setAttribute(new osg::FragmentProgram);
        CHECK(counted(geometry, "shader-program") == 0); // the mode is off
        state.setMode(GL_FRAGMENT_PROGRAM_ARB, kOn);
        CHECK(counted(geometry, "shader-program") == 1);
    }
    SECTION("stencil")
    {
        state.setAttribute(new osg::Stencil);
        CHECK(counted(geometry, "stencil") == 0);
        state.setMode(GL_STENCIL_TEST, kOn);
        CHECK(counted(geometry, "stencil") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.stencil") == 1);
    }
    SECTION("colour mask")
    {
        const osg::ref_ptr<osg::ColorMask> mask = new osg::ColorMask(true, true, true, false);
        state.setAttribute(mask);
        CHECK(counted(geometry, "color-mask") == 0);
        mask->setMask(true, false, true, true);
        CHECK(counted(geometry, "color-mask") == 1);
        CHECK(countOf(convertGraph(geometry), "approximated.color-mask") == 1);
    }
    SECTION("not those above the scene, which hold for its picture")
    {
        const osg::ref_ptr<osg::StateSet> above = new osg::StateSet;
        above->setAttributeAndModes(new osg::Stencil, kOn | osg::StateAttribute::OVERRIDE);
        above->setAttribute(new osg::ColorMask(true, false, false, true));
        ConversionInput input = inputFor(geometry);
        input.rasterizesRest = true;
        input.inheritedState = {above};
        CHECK(SceneConverter().convert(input).scene->instances.size() == 1);
    }
}
