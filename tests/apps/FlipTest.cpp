// FlipTest.cpp - the published properties of FLIP, and values computed by hand.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "apps/osgraytracebench/report/Flip.h"

#include <cmath>

using namespace osgRayTrace::bench;
using osgRayTrace::engine::test::Uniform;

namespace
{

constexpr int kSide = 24;

std::vector<float> constant(float r, float g, float b)
{
    std::vector<float> picture;
    for (int i = 0; i < kSide * kSide; ++i)
        picture.insert(picture.end(), {r, g, b});
    return picture;
}

std::vector<float> noisy(float amplitude, uint32_t seed)
{
    Uniform random(seed);
    std::vector<float> picture = constant(0.5f, 0.4f, 0.3f);
    for (float& value : picture)
        value += amplitude * (random() - 0.5f);
    return picture;
}

double mean(const std::vector<float>& a, const std::vector<float>& b)
{
    return meanFlip(a, b, kSide, kSide);
}

} // namespace

TEST_CASE("flip: a picture does not differ from itself", "[report]")
{
    const std::vector<float> picture = noisy(0.5f, 1);
    for (const float value : flip(picture, picture, kSide, kSide))
        CHECK(value == 0.0f);
}

TEST_CASE("flip: symmetric, and in [0,1]", "[report]")
{
    const std::vector<float> a = noisy(0.9f, 1), b = noisy(0.9f, 2);
    const std::vector<float> forth = flip(a, b, kSide, kSide), back = flip(b, a, kSide, kSide);
    for (std::size_t i = 0; i < forth.size(); ++i)
    {
        CHECK(forth[i] == Approx(back[i]).margin(1e-6));
        CHECK(forth[i] >= 0.0f);
        CHECK(forth[i] <= 1.0f);
    }
}

// Even pictures have no features, so FLIP is the colour difference alone. Black and white are 100
// apart in lightness: 100^0.7 = 25.119. The largest difference is that of green, L*a*b* (87.735,
// -86.183, 83.180), and blue (32.297, 79.188, -107.860): with chroma times L/100, |dL| = 55.438 and
// the chroma's distance 147.8, 203.3^0.7 = 41.27. The knee is at 0.4 of it, 16.51: 0.95 + (25.12 -
// 16.51) / (41.27 - 16.51) * 0.05.
TEST_CASE("flip: black against white, green against blue", "[report]")
{
    CHECK(mean(constant(0, 0, 0), constant(1, 1, 1)) == Approx(0.9674).margin(2e-4));
    CHECK(mean(constant(0, 1, 0), constant(0, 0, 1)) == Approx(1.0).margin(1e-6));
}

TEST_CASE("flip: more noise is more difference, blue noise less than green", "[report]")
{
    const std::vector<float> right = constant(0.5f, 0.4f, 0.3f);
    const double little = mean(right, noisy(0.05f, 3)), more = mean(right, noisy(0.2f, 3)),
                 most = mean(right, noisy(0.6f, 3));
    CHECK(little < more);
    CHECK(more < most);

    // The eye blurs blue-yellow contrast much more than light and dark.
    std::vector<float> green = right, blue = right;
    Uniform random(4);
    for (std::size_t i = 0; i < right.size(); i += 3)
    {
        const float noise = 0.3f * (random() - 0.5f);
        green[i + 1] += noise;
        blue[i + 2] += noise;
    }
    CHECK(mean(right, blue) < 0.6 * mean(right, green));
}

TEST_CASE("flip: a line counts for more than its colour, seen from nearer for more", "[report]")
{
    const std::vector<float> right = constant(0.5f, 0.5f, 0.5f);
    std::vector<float> line = right;
    for (int y = 0; y < kSide; ++y)
        for (int c = 0; c < 3; ++c)
            line[static_cast<std::size_t>(3 * (y * kSide + kSide / 2) + c)] = 0.9f;
    const std::vector<float> far = flip(right, line, kSide, kSide, 67.0),
                             near = flip(right, line, kSide, kSide, 20.0);
    const std::size_t centre = kSide / 2 * kSide + kSide / 2;
    CHECK(near[centre] > far[centre]);
    CHECK(far[centre] > far[centre - 8]);
}
