// TextureLanes.cpp - filtered texels of one image as vector code. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/TextureLanes.h"

#include "osgRayTrace/shading/TextureSample.h"

#include <cmath>
#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

/// Holds the places of lanes between four texels: the texel below on the left, and the shares of
/// those to the right and above.
struct TexelPlaces
{
    Lanes<int> first;
    FloatLanes shareX, shareY;
};

/// Returns the largest integer that is not above x.
OSGRAYTRACE_INLINE float floorOf(float x)
{
    const auto whole = static_cast<float>(static_cast<int>(x));
    return whole - select(x < whole, 1.0f, 0.0f);
}

/// Finds the places of the lanes. Returns those whose four texels are inside of the image, so that
/// it does not matter what is beyond its edges.
OSGRAYTRACE_KERNEL
LaneMask placesOf(const FloatLanes& s, const FloatLanes& t, const Texture& texture, LaneMask lanes,
                  TexelPlaces& places)
{
    constexpr float kLargest = 1e4f; // repetitions that leave floats enough digits
    const int width = texture.width;
    const auto w = static_cast<float>(width), h = static_cast<float>(texture.height);
    const uint32_t repeatsS = maskOf(texture.wrapS == TextureWrap::Repeat),
                   repeatsT = maskOf(texture.wrapT == TextureWrap::Repeat);
    LaneMask inside = 0;
    OSGRAYTRACE_SIMD_OR(inside)
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t known = laneBit(lanes, i) & maskOf(std::fabs(s[i]) < kLargest) &
                               maskOf(std::fabs(t[i]) < kLargest);
        const float u = select(known, s[i], 0.0f), v = select(known, t[i], 0.0f);
        const float x = (u - select(repeatsS, floorOf(u), 0.0f)) * w - 0.5f,
                    y = (v - select(repeatsT, floorOf(v), 0.0f)) * h - 0.5f;
        const uint32_t between = known & maskOf(x >= 0.0f) & maskOf(y >= 0.0f) &
                                 maskOf(x < w - 1.0f) & maskOf(y < h - 1.0f);
        const float px = select(between, x, 0.0f), py = select(between, y, 0.0f);
        const int ix = static_cast<int>(px), iy = static_cast<int>(py);
        places.first[i] = iy * width + ix;
        places.shareX[i] = px - static_cast<float>(ix);
        places.shareY[i] = py - static_cast<float>(iy);
        inside |= bitOfLane(between, i);
    }
    return inside;
}

/// Holds the four texels of each lane, red in the lowest byte.
struct TexelLanes
{
    UintLanes texel[4];
};

OSGRAYTRACE_KERNEL
void mixTexels(const TexelLanes& texels, const TexelPlaces& places, Vec3Lanes& color)
{
    FloatLanes* channels[3] = {&color.x, &color.y, &color.z};
    for (int c = 0; c < 3; ++c)
    {
        FloatLanes& out = *channels[c];
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            const auto value = [&](int k)
            { return static_cast<float>(static_cast<int>(texels.texel[k][i] >> 8 * c & 0xffu)); };
            const float fx = places.shareX[i], fy = places.shareY[i];
            const float low = value(0) * (1.0f - fx) + value(1) * fx,
                        high = value(2) * (1.0f - fx) + value(3) * fx;
            out[i] = (low * (1.0f - fy) + high * fy) * (1.0f / 255.0f);
        }
    }
}

/// Sets the colours of lanes whose four texels are inside of an image of bytes.
void linearColors(const Texture& texture, const TexelPlaces& places, LaneMask lanes,
                  Vec3Lanes& color)
{
    const uint8_t* bytes = texture.bytes.data();
    const std::size_t above = 4 * static_cast<std::size_t>(texture.width);
    TexelLanes texels = {};
    for (const int i : lanesIn(lanes))
    {
        const uint8_t* first = bytes + 4 * static_cast<std::size_t>(places.first[i]);
        std::memcpy(&texels.texel[0][i], first, 4);
        std::memcpy(&texels.texel[1][i], first + 4, 4);
        std::memcpy(&texels.texel[2][i], first + above, 4);
        std::memcpy(&texels.texel[3][i], first + above + 4, 4);
    }
    Vec3Lanes colors;
    mixTexels(texels, places, colors);
    for (const int i : lanesIn(lanes))
        setLane(color, i, plainOf(colors, i));
}

} // namespace

void textureColors(const Texture& texture, const FloatLanes& s, const FloatLanes& t, LaneMask lanes,
                   Vec3Lanes& color)
{
    TexelPlaces places;
    LaneMask simple = 0;
    if (texture.linearFilter && !texture.decodeSrgb && !texture.bytes.empty())
        simple = placesOf(s, t, texture, lanes, places);
    if (simple) linearColors(texture, places, simple, color);
    for (const int i : lanesIn(lanes & ~simple))
        setLane(color, i, Vec3(sampleTexture(texture, Vec2(s[i], t[i]))));
}

void textureColors(const Texture& texture, const FloatLanes& s, const FloatLanes& t,
                   const FloatLanes& widths, LaneMask lanes, Vec3Lanes& color)
{
    MipChoice choices[kLanes];
    for (const int i : lanesIn(lanes))
        choices[i] = mipFor(texture, widths[i]);
    for (LaneMask left = lanes; left;)
    {
        const int level = choices[firstLane(left)].level;
        LaneMask same = 0, blended = 0;
        for (const int i : lanesIn(left))
        {
            same |= static_cast<LaneMask>(choices[i].level == level) << i;
            blended |= static_cast<LaneMask>(choices[i].level == level && choices[i].share > 0.0f)
                       << i;
        }
        left &= ~same;
        textureColors(levelOf(texture, level), s, t, same, color);
        if (!blended) continue;
        Vec3Lanes coarser;
        textureColors(levelOf(texture, level + 1), s, t, blended, coarser);
        for (const int i : lanesIn(blended))
            setLane(color, i, glm::mix(laneOf(color, i), laneOf(coarser, i), choices[i].share));
    }
}

} // namespace osgRayTrace::engine
