// VeiledBackgroundTest.cpp - display values of what media show before an opaque background.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/film/Resolve.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

using Byte = uint8_t;

/// Returns what a display of 8 bits shows of the pixel over the colour.
int blended(const Byte* pixel, int channel, int below)
{
    return pixel[channel] + ((255 - pixel[3]) * below + 127) / 255;
}

int nearestByte(double linear)
{
    return static_cast<int>(
        std::lround(255.0 * double(srgbFromLinear(float(std::clamp(linear, 0.0, 1.0))))));
}

/// Pixels of light and alpha from the thinnest air to opaque surfaces.
std::vector<float> pixels()
{
    std::vector<float> rgba;
    for (int a = 0; a <= 400; ++a)
    {
        for (int s = 0; s <= 8; ++s)
        {
            const float alpha = static_cast<float>(a) / 400.0f * static_cast<float>(a) / 400.0f;
            const float light = alpha * static_cast<float>(s) * 0.15f;
            rgba.insert(rgba.end(), {light, 0.5f * light, 0.1f * light, alpha});
        }
    }
    return rgba;
}

} // namespace

TEST_CASE("veiled background: what is blended is the encoded sum in linear light", "[film]")
{
    const std::vector<float> rgba = pixels();
    const std::size_t count = rgba.size() / 4;
    for (const Vec3 color : {Vec3(0.0f), Vec3(1.0f), Vec3(51.0f, 51.0f, 102.0f) / 255.0f})
    {
        for (const float ev : {0.0f, -1.0f})
        {
            ToneMap toneMap{ev};
            toneMap.veiled = true;
            toneMap.background = color;
            std::vector<Byte> bytes(4 * count), behind, over(4 * count);
            displayPixels(rgba.data(), count, toneMap, bytes.data());
            for (std::size_t p = 0; p < count; ++p)
                for (int c = 0; c < 4; ++c)
                    behind.push_back(static_cast<Byte>(c < 3 ? std::lround(255.0f * color[c]) : 0));
            displayOver(rgba.data(), behind.data(), count, toneMap, over.data());
            int wrong = 0;
            for (std::size_t p = 0; p < count; ++p)
            {
                const float* pixel = &rgba[4 * p];
                if (pixel[3] <= 0.0f) wrong += bytes[4 * p + 3] != 0;
                for (int c = 0; c < 3; ++c)
                {
                    const int below = behind[4 * p + static_cast<std::size_t>(c)];
                    const double linear = linearFromSrgb(static_cast<float>(below) / 255.0f);
                    const double shown = std::min(1.0, std::exp2(double(ev)) * double(pixel[c]));
                    const int expected = nearestByte(shown + (1.0 - double(pixel[3])) * linear);
                    // One step: encodings at the border of two bytes.
                    wrong += std::abs(blended(&bytes[4 * p], c, below) - expected) > 1;
                    wrong += std::abs(over[4 * p + static_cast<std::size_t>(c)] - expected) > 1;
                }
            }
            CAPTURE(color.x, ev);
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("veiled background: light before nothing is as bright as before a black wall", "[film]")
{
    for (const ToneCurve curve : {ToneCurve::Srgb, ToneCurve::Neutral, ToneCurve::Agx})
    {
        ToneMap toneMap{0.5f, false, curve};
        toneMap.veiled = true;
        int wrong = 0;
        for (int a = 1; a <= 1000; ++a)
        {
            const float alpha = static_cast<float>(a) / 1000.0f;
            const float air[8] = {0.6f * alpha, 0.4f * alpha, 0.2f * alpha, alpha,
                                  0.6f * alpha, 0.4f * alpha, 0.2f * alpha, 1.0f};
            Byte bytes[8];
            displayPixels(air, 2, toneMap, bytes);
            for (int c = 0; c < 3; ++c)
                wrong += std::abs(bytes[c] - bytes[4 + c]) > 1;
        }
        CAPTURE(static_cast<int>(curve));
        CHECK(wrong == 0);
    }
}

TEST_CASE("veiled background: display values of OpenGL's look are blended as before", "[film]")
{
    const std::vector<float> rgba = pixels();
    const std::size_t count = rgba.size() / 4;
    ToneMap plain{0.0f, true}, veiled = plain;
    veiled.veiled = true;
    std::vector<Byte> a(4 * count), b(4 * count);
    displayPixels(rgba.data(), count, plain, a.data());
    displayPixels(rgba.data(), count, veiled, b.data());
    CHECK(a == b);
}
