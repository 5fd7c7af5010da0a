// TextureSampleTest.cpp - filtering, wrapping and decoding of textures.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <cmath>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

/// Returns 4 x 2 texels with red = column / 10 and green = row / 10.
Texture ramp(bool linear, TextureWrap wrap)
{
    Texture texture;
    texture.width = 4;
    texture.height = 2;
    texture.linearFilter = linear;
    texture.wrapS = texture.wrapT = wrap;
    for (int y = 0; y < 2; ++y)
    {
        for (int x = 0; x < 4; ++x)
            texture.floats.insert(texture.floats.end(), {x / 10.0f, y / 10.0f, 0.5f, 1.0f});
    }
    return texture;
}

float red(const Texture& texture, float u, float v)
{
    return sampleTexture(texture, Vec2(u, v)).x;
}

} // namespace

TEST_CASE("texture: nearest takes the texel that holds the point", "[shading]")
{
    const Texture texture = ramp(false, TextureWrap::Repeat);
    CHECK(red(texture, 0.0f, 0.0f) == 0.0f);
    CHECK(red(texture, 0.26f, 0.0f) == 0.1f);
    CHECK(red(texture, 0.74f, 0.0f) == 0.2f);
    CHECK(red(texture, 0.99f, 0.0f) == 0.3f);
    CHECK(sampleTexture(texture, Vec2(0.1f, 0.9f)).y == 0.1f); // v upwards, row 0 at the bottom
    CHECK(sampleTexture(texture, Vec2(0.1f, 0.9f)).z == 0.5f);
}

TEST_CASE("texture: bilinear between texel centres", "[shading]")
{
    const Texture texture = ramp(true, TextureWrap::ClampToEdge);
    CHECK(red(texture, 0.125f, 0.25f) == Approx(0.0).margin(1e-7));
    CHECK(red(texture, 0.25f, 0.25f) == Approx(0.05));
    CHECK(red(texture, 0.5f, 0.7f) == Approx(0.15));
    CHECK(sampleTexture(texture, Vec2(0.3f, 0.5f)).y == Approx(0.05));
    CHECK(red(texture, 0.0f, 0.0f) == Approx(0.0).margin(1e-7)); // clamped beyond the outer centres
    CHECK(red(texture, 1.0f, 0.0f) == Approx(0.3));
}

TEST_CASE("texture: wrap modes", "[shading]")
{
    const Texture repeat = ramp(false, TextureWrap::Repeat);
    CHECK(red(repeat, 1.1f, 0.0f) == 0.0f);
    CHECK(red(repeat, -0.1f, 0.0f) == 0.3f);
    CHECK(red(repeat, -7.9f, 0.0f) == 0.0f);
    const Texture clamp = ramp(false, TextureWrap::ClampToEdge);
    CHECK(red(clamp, 1.6f, 0.0f) == 0.3f);
    CHECK(red(clamp, -5.0f, 0.0f) == 0.0f);
    const Texture mirror = ramp(false, TextureWrap::Mirror);
    CHECK(red(mirror, 1.1f, 0.0f) == 0.3f);
    CHECK(red(mirror, 1.9f, 0.0f) == 0.0f);
    CHECK(red(mirror, 2.1f, 0.0f) == 0.0f);
    CHECK(red(mirror, -0.3f, 0.0f) == 0.1f);
    CHECK(red(ramp(true, TextureWrap::Repeat), 0.0f, 0.0f) == Approx(0.15)); // across the seam
}

TEST_CASE("texture: sRGB bytes are decoded before filtering, alpha never", "[shading]")
{
    Texture texture;
    texture.width = 2;
    texture.height = 1;
    texture.wrapS = texture.wrapT = TextureWrap::ClampToEdge;
    texture.bytes = {0, 128, 255, 128, 255, 128, 255, 128};
    CHECK(sampleTexture(texture, Vec2(0.5f, 0.5f)).x == Approx(0.5));
    CHECK(sampleTexture(texture, Vec2(0.5f, 0.5f)).y == Approx(128.0 / 255.0));
    texture.decodeSrgb = true;
    CHECK(sampleTexture(texture, Vec2(0.5f, 0.5f)).x == Approx(0.5)); // half of linear 0 and 1
    CHECK(sampleTexture(texture, Vec2(0.5f, 0.5f)).y == Approx(linearFromSrgb(128.0f / 255.0f)));
    CHECK(sampleTexture(texture, Vec2(0.5f, 0.5f)).z == 1.0f);
    CHECK(sampleTexture(texture, Vec2(0.5f, 0.5f)).w == Approx(128.0 / 255.0));
}

TEST_CASE("texture: any coordinate is safe", "[shading]")
{
    const float nan = std::nanf("");
    for (const TextureWrap wrap :
         {TextureWrap::Repeat, TextureWrap::ClampToEdge, TextureWrap::Mirror})
    {
        for (const bool linear : {false, true})
        {
            const Texture texture = ramp(linear, wrap);
            for (const float u : {nan, kInfinity, -kInfinity, 1e30f, -1e30f, 2e8f, -2e8f})
            {
                const Vec4 a = sampleTexture(texture, Vec2(u, 0.3f)),
                           b = sampleTexture(texture, Vec2(0.3f, u));
                CHECK((a.x >= 0.0f && a.x <= 0.3f));
                CHECK((b.y >= 0.0f && b.y <= 0.1f));
            }
        }
    }
}

TEST_CASE("texture: 3-D images, between slices and beyond them", "[shading]")
{
    Texture texture = ramp(true, TextureWrap::ClampToEdge);
    texture.depth = 3;
    const std::vector<float> slice = texture.floats;
    for (int z = 1; z < 3; ++z)
        for (std::size_t i = 0; i < slice.size(); ++i)
            texture.floats.push_back(i % 4 == 2 ? 0.5f + 0.1f * float(z) : slice[i]);
    texture.border = Vec4(0.0f, 0.0f, 0.9f, 0.0f);
    const auto blue = [&texture](float r, float q = 1.0f)
    { return sampleTexture(texture, Vec4(0.5f * q, 0.5f * q, r * q, q)).z; };
    texture.wrapR = TextureWrap::ClampToEdge;
    CHECK(blue(0.5f / 3) == Approx(0.5));
    CHECK(blue(0.5f) == Approx(0.6));
    CHECK(blue(2.0f / 3) == Approx(0.65));
    CHECK(blue(2.0f / 3, 4.0f) == Approx(0.65));
    CHECK(blue(-2.0f) == Approx(0.5));
    CHECK(blue(2.0f) == Approx(0.7));
    CHECK(blue(std::nanf("")) == Approx(0.5));
    CHECK(sampleTexture(texture, Vec4(0.5f, 0.25f, 0.5f, 1.0f)).x == Approx(0.15));
    texture.wrapR = TextureWrap::Repeat;
    CHECK(blue(1.5f) == Approx(0.6));
    CHECK(blue(0.0f) == Approx(0.6)); // between the last and the first slice
    texture.wrapR = TextureWrap::Mirror;
    CHECK(blue(1.0f + 0.5f / 3) == Approx(0.7));
    texture.wrapR = TextureWrap::ClampToBorder;
    CHECK(blue(5.0f) == Approx(0.9));
    CHECK(blue(1.0f) == Approx(0.8));
    texture.linearFilter = false;
    CHECK(blue(0.34f) == Approx(0.6));
    CHECK(blue(-0.01f) == Approx(0.9));
    texture.wrapR = TextureWrap::Clamp;
    CHECK(blue(9.0f) == Approx(0.7)); // the nearest texel has no border
}
