// EnlargeTest.cpp - small pictures are enlarged as OpenGL's linear filter does it.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Enlarge.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

using namespace osgRayTrace::engine;

namespace
{

struct Picture
{
    Picture(int w, int h)
        : width(w), height(h), rgba(4 * std::size_t(w * h)), depth(std::size_t(w * h))
    {
    }
    DisplayPixels pixels() { return {width, height, rgba.data(), depth.data()}; }
    int width, height;
    std::vector<uint8_t> rgba;
    std::vector<float> depth;
};

Picture noise(int width, int height)
{
    Picture picture(width, height);
    std::mt19937 random(3);
    for (uint8_t& value : picture.rgba)
        value = static_cast<uint8_t>(random());
    for (float& value : picture.depth)
        value = static_cast<float>(random() % 1000) / 1000.0f;
    return picture;
}

Picture enlarged(Picture small, int width, int height)
{
    Picture large(width, height);
    enlarge(small.pixels(), large.pixels(), Workers(2));
    return large;
}

/// Filters as OpenGL 4.6, section 8.14.3, defines it: GL_LINEAR with GL_CLAMP_TO_EDGE, in double.
double linear(const Picture& small, int x, int y, int width, int height, int channel)
{
    const double u = (x + 0.5) / width * small.width - 0.5,
                 v = (y + 0.5) / height * small.height - 0.5;
    const double i = std::floor(u), j = std::floor(v);
    const auto texel = [&](double column, double row)
    {
        const int cx = std::clamp(int(column), 0, small.width - 1),
                  cy = std::clamp(int(row), 0, small.height - 1);
        return double(small.rgba[4 * std::size_t(cy * small.width + cx) + std::size_t(channel)]);
    };
    const double a = u - i, b = v - j;
    return (1 - a) * (1 - b) * texel(i, j) + a * (1 - b) * texel(i + 1, j) +
           (1 - a) * b * texel(i, j + 1) + a * b * texel(i + 1, j + 1);
}

} // namespace

TEST_CASE("enlarge: colours are OpenGL's linear filter, depths those of the nearest pixel",
          "[film]")
{
    for (const auto& [w, h, width, height] : {std::tuple(9, 7, 27, 21), std::tuple(10, 5, 37, 16),
                                              std::tuple(1, 1, 5, 4), std::tuple(3, 1, 4, 9)})
    {
        const Picture small = noise(w, h), large = enlarged(small, width, height);
        double worst = 0.0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
            {
                const auto p = std::size_t(y * width + x);
                for (int c = 0; c < 4; ++c)
                    worst = std::max(worst, std::abs(linear(small, x, y, width, height, c) -
                                                     large.rgba[4 * p + std::size_t(c)]));
                const int cx = int((x + 0.5) / width * w), cy = int((y + 0.5) / height * h);
                REQUIRE(large.depth[p] == small.depth[std::size_t(cy * w + cx)]);
            }
        CHECK(worst <= 0.51);
    }
}

TEST_CASE("enlarge: of the same size nothing changes", "[film]")
{
    const Picture small = noise(33, 17), large = enlarged(small, 33, 17);
    CHECK(large.rgba == small.rgba);
    CHECK(large.depth == small.depth);
}
