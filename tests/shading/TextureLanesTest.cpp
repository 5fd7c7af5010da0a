// TextureLanesTest.cpp - texture look-ups of sixteen lanes are those of single points.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/TextureLanes.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("texture lanes: the colours of single look-ups, for all kinds of textures", "[shading]")
{
    Uniform random(3);
    Texture texture;
    texture.width = 7;
    texture.height = 5;
    texture.border = Vec4(0.3f, 0.6f, 0.9f, 1.0f);
    for (int i = 0; i < 4 * 7 * 5; ++i)
        texture.bytes.push_back(static_cast<uint8_t>(255.0f * random()));
    constexpr float kLarge = std::numeric_limits<float>::max();
    const float strange[] = {0.0f, 1.0f, -1.0f, 1e5f, -1e9f, kLarge, -kLarge, kInfinity, NAN, 0.5f};
    float largest = 0.0f;
    int compared = 0;
    for (const TextureWrap wrap :
         {TextureWrap::Repeat, TextureWrap::ClampToEdge, TextureWrap::Mirror, TextureWrap::Clamp,
          TextureWrap::ClampToBorder})
        for (const bool linear : {true, false})
            for (const bool decode : {true, false})
                for (int round = 0; round < 100; ++round)
                {
                    texture.wrapS = wrap;
                    texture.wrapT = round % 2 ? wrap : TextureWrap::Repeat;
                    texture.linearFilter = linear;
                    texture.decodeSrgb = decode;
                    FloatLanes s, t;
                    for (int i = 0; i < kLanes; ++i)
                    {
                        s[i] = 3.0f * random() - 1.0f;
                        t[i] = 3.0f * random() - 1.0f;
                    }
                    s[3] = strange[round % 10];
                    t[5] = strange[round / 10];
                    const LaneMask lanes = round % 3 ? kAllLanes : 0x5a3cu;
                    Vec3Lanes color;
                    for (int i = 0; i < kLanes; ++i)
                        setLane(color, i, Vec3(-1.0f));
                    textureColors(texture, s, t, lanes, color);
                    for (int i = 0; i < kLanes; ++i)
                    {
                        const bool active = (lanes >> i) & 1u;
                        const Vec3 expected =
                            active ? Vec3(sampleTexture(texture, Vec2(s[i], t[i]))) : Vec3(-1.0f);
                        const Vec3 off = glm::abs(laneOf(color, i) - expected);
                        largest = std::max({largest, off.x, off.y, off.z});
                        ++compared;
                    }
                }
    CHECK(compared == 5 * 2 * 2 * 100 * kLanes);
    CHECK(largest < 2e-5f);
}
