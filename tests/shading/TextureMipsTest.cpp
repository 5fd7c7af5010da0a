// TextureMipsTest.cpp - mips are means over areas, and look-ups find the right ones.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/MaterialTable.h"
#include "osgRayTrace/shading/TextureCoordinates.h"
#include "osgRayTrace/shading/TextureLanes.h"
#include "osgRayTrace/shading/TextureMips.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Texture noise(int width, int height, bool decode)
{
    Uniform random(5);
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.decodeSrgb = decode;
    for (int i = 0; i < 4 * width * height; ++i)
        texture.bytes.push_back(static_cast<uint8_t>(255.99f * random()));
    return texture;
}

/// Returns the mean of the texels, linear.
Vec4 meanOf(Texture texture)
{
    texture.linearFilter = false;
    Vec4 sum(0.0f);
    for (int y = 0; y < texture.height; ++y)
        for (int x = 0; x < texture.width; ++x)
            sum += sampleTexture(texture, Vec2((float(x) + 0.5f) / float(texture.width),
                                               (float(y) + 0.5f) / float(texture.height)));
    return sum / float(texture.width * texture.height);
}

Texture ramp(std::vector<float> reds)
{
    Texture texture;
    texture.width = static_cast<int>(reds.size());
    texture.height = 1;
    for (const float red : reds)
        texture.floats.insert(texture.floats.end(), {red, 2.0f * red, 0.0f, 1.0f});
    return texture;
}

} // namespace

TEST_CASE("mips: each has the image's mean, in linear values and for any size", "[shading]")
{
    for (const bool decode : {false, true})
        for (const glm::ivec2 size : {glm::ivec2(16, 16), glm::ivec2(37, 5), glm::ivec2(1, 9)})
        {
            const Texture image = noise(size.x, size.y, decode);
            const std::vector<Texture> mips = textureMips(image, true);
            glm::ivec2 expected = size;
            CHECK(mips.size() == std::size_t(std::log2(std::max(size.x, size.y))));
            for (const Texture& mip : mips)
            {
                expected = glm::max(expected / 2, 1);
                CHECK(mip.width == expected.x);
                CHECK(mip.height == expected.y);
                CHECK(mip.decodeSrgb == decode);
                CAPTURE(decode, size.x, size.y, mip.width);
                // A byte of 1x1 texels is off by half a step of sRGB, 0.0045, at most.
                const Vec4 off = glm::abs(meanOf(mip) - meanOf(image));
                CHECK(std::max({off.x, off.y, off.z, off.w}) < 0.0046f);
            }
            CHECK(mips.back().width * mips.back().height == 1);
        }
}

TEST_CASE("mips: black and white make the grey that is half as bright", "[shading]")
{
    Texture checks;
    checks.width = checks.height = 2;
    checks.bytes = {0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0};
    CHECK(textureMips(checks, true)[0].bytes == std::vector<uint8_t>{128, 128, 128, 128});
    checks.decodeSrgb = true; // alpha is linear
    CHECK(textureMips(checks, true)[0].bytes == std::vector<uint8_t>{188, 188, 188, 128});
}

TEST_CASE("mips: texels of odd images are shared by area", "[shading]")
{
    const std::vector<Texture> mips = textureMips(ramp({1.0f, 2.0f, 4.0f, 8.0f, 16.0f}), true);
    REQUIRE(mips.size() == 2);
    CHECK(mips[0].floats[0] == Approx((1.0 + 2.0 + 0.5 * 4.0) / 2.5));
    CHECK(mips[0].floats[4] == Approx((0.5 * 4.0 + 8.0 + 16.0) / 2.5));
    CHECK(mips[0].floats[5] == Approx(2.0 * (0.5 * 4.0 + 8.0 + 16.0) / 2.5));
    CHECK(mips[1].floats[0] == Approx(31.0 / 5.0));
    CHECK(textureMips(ramp({1.0f}), true).empty());
}

TEST_CASE("mips: a footprint reads the level whose texels are as large", "[shading]")
{
    Texture image = noise(64, 16, true);
    CHECK(mipFor(image, 1.0f).level == 0); // without mips
    image.mips = textureMips(image, true);
    REQUIRE(image.mips.size() == 6);
    const float texel = 1.0f / 32.0f; // by area: the root of 64 * 16
    CHECK(mipFor(image, 0.0f).level == 0);
    CHECK(mipFor(image, std::nanf("")).level == 0);
    CHECK(mipFor(image, 0.9f * texel).share == 0.0f);
    CHECK(mipFor(image, 4.0f * texel).level == 2);
    CHECK(mipFor(image, 4.0f * texel).share == Approx(0.0).margin(1e-5));
    CHECK(mipFor(image, 6.0f * texel).level == 2);
    CHECK(mipFor(image, 6.0f * texel).share == Approx(std::log2(1.5)));
    for (const float width : {1e6f, kInfinity})
    {
        CHECK(mipFor(image, width).level == 6);
        CHECK(mipFor(image, width).share == 0.0f);
    }
    image.blendsMips = false;
    CHECK(mipFor(image, 5.5f * texel).level == 2);
    CHECK(mipFor(image, 5.8f * texel).level == 3);
    CHECK(mipFor(image, 5.8f * texel).share == 0.0f);
}

TEST_CASE("mips: look-ups of sixteen lanes are those of single points", "[shading]")
{
    Uniform random(9);
    for (const bool decode : {false, true})
    {
        Texture image = noise(32, 32, decode);
        image.mips = textureMips(image, true);
        int blended = 0;
        for (int round = 0; round < 50; ++round)
        {
            FloatLanes s, t, widths;
            for (int i = 0; i < kLanes; ++i)
            {
                s[i] = 3.0f * random() - 1.0f;
                t[i] = 3.0f * random() - 1.0f;
                widths[i] = std::exp2(6.0f * random() - 7.0f);
                blended += mipFor(image, widths[i]).share > 0.0f;
            }
            widths[3] = 0.0f;
            const LaneMask lanes = round % 3 ? kAllLanes : 0x5a3cu;
            Vec3Lanes color;
            for (int i = 0; i < kLanes; ++i)
                setLane(color, i, Vec3(-1.0f));
            textureColors(image, s, t, widths, lanes, color);
            for (int i = 0; i < kLanes; ++i)
            {
                const Vec3 expected = (lanes >> i) & 1u
                                          ? Vec3(sampleTexture(image, Vec2(s[i], t[i]), widths[i]))
                                          : Vec3(-1.0f);
                CHECK(glm::length(laneOf(color, i) - expected) < 2e-5f);
            }
        }
        CHECK(blended > 300);
    }
}

TEST_CASE("mips: texture matrices and planes scale footprints by area", "[shading]")
{
    TexturePoint point;
    point.uvWidth = 0.01f;
    point.uv1Width = 0.02f;
    point.footprint = 0.5f;
    point.normal = Vec3(0.0f, 0.0f, 1.0f);
    TextureMapping mapping;
    CHECK(textureWidth(mapping, point) == 0.01f);
    mapping.coordinates = TextureCoordinates::Uv1;
    CHECK(textureWidth(mapping, point) == 0.02f);
    mapping.transformed = true;
    mapping.matrix = Mat4(1.0f);
    mapping.matrix[0][0] = 9.0f;
    mapping.matrix[1][0] = 5.0f; // a shear leaves areas as they are
    mapping.matrix[1][1] = 4.0f;
    CHECK(textureWidth(mapping, point) == Approx(0.12));
    mapping.coordinates = TextureCoordinates::Position;
    CHECK(textureWidth(mapping, point) == Approx(3.0));
    point.normal = Vec3(0.0f, 0.6f, 0.8f); // the slope is longer than its shadow on the map
    CHECK(textureWidth(mapping, point) == Approx(0.5 * std::sqrt(36.0 * 0.8)));
    mapping.coordinates = TextureCoordinates::SphereMap;
    CHECK(textureWidth(mapping, point) == 0.0f);
    mapping.coordinates = TextureCoordinates::Uv0;
    mapping.matrix[0][3] = 1.0f; // projective
    CHECK(textureWidth(mapping, point) == 0.0f);
}

TEST_CASE("mips: textures of films and of anisotropy are read with their footprints", "[shading]")
{
    Scene scene;
    const auto texture = std::make_shared<Texture>();
    texture->width = texture->height = 2;
    texture->linearFilter = false;
    // One column of two is black in red and blue.
    texture->bytes = {255, 128, 255, 255, 0, 128, 0, 255, 255, 128, 255, 255, 0, 128, 0, 255};
    texture->mips = textureMips(*texture, false);
    scene.textures = {texture};
    MaterialDetail detail;
    detail.iridescence = detail.anisotropy = 1.0f;
    detail.textures[kIridescenceRole] = detail.textures[kAnisotropyRole] = 0;
    Material material;
    material.model = MaterialModel::Physical;
    material.metallic = 1.0f;
    material.roughness = 0.5f;
    material.detail = std::make_shared<MaterialDetail>(detail);
    scene.materials = {material};
    const MaterialTable table(scene);
    CHECK(table[0].mipmapped);
    MaterialPoint point;
    point.uv = Vec2(0.25f, 0.25f);
    const Bsdf sharp = table.bsdf(0, point);
    point.uvWidth = 1.0f;
    const Bsdf mean = table.bsdf(0, point);
    CHECK(sharp.film == 1.0f);
    CHECK(mean.film == Approx(128.0 / 255.0)); // mips of bytes are bytes
    CHECK(sharp.alphaTangent == 1.0f);
    CHECK(mean.alphaTangent == Approx(0.25 + 0.75 * 0.25).margin(0.004));
}
