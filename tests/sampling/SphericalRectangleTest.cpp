// SphericalRectangleTest.cpp - directions towards rectangles: solid angle, distribution, borders.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/sampling/SphericalRectangle.h"

#include "tests/Catch.h"
#include "tests/Statistics.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the solid angle of the rectangle from (0, 0) to (x, y) at distance z, in double.
double cornerAngle(double x, double y, double z)
{
    return std::atan2(x * y, z * std::sqrt(x * x + y * y + z * z));
}

double solidAngle(double x0, double x1, double y0, double y1, double z)
{
    return cornerAngle(x1, y1, z) - cornerAngle(x0, y1, z) - cornerAngle(x1, y0, z) +
           cornerAngle(x0, y0, z);
}

struct Case
{
    const char* name;
    float x0, y0, width, height, z;
};

const Case kCases[] = {
    {"above", -0.5f, -0.5f, 1.0f, 1.0f, 1.0f},
    {"beside", 0.5f, -0.5f, 1.0f, 1.0f, 1.0f},
    {"behind", 0.2f, 0.1f, 3.0f, 4.0f, -0.4f},
    {"below a corner", -1e-3f, -1e-3f, 1.0f, 1.0f, 1e-3f},
    {"close", -1.0f, -1.0f, 3.0f, 4.0f, 0.01f},
    {"narrow", -5.0f, 0.0f, 10.0f, 0.1f, 0.5f},
    {"grazing", 1.0f, 1.0f, 3.0f, 4.0f, 0.5f},
    {"huge", -300.0f, -2.0f, 400.0f, 300.0f, 5.0f},
};

} // namespace

TEST_CASE("spherical rectangle: angles have the digits of a float", "[sampling]")
{
    for (int k = 0; k <= 4000; ++k)
    {
        const double angle = 3.14159265358979 * k / 4000.0;
        const auto y = static_cast<float>(std::max(0.0, std::sin(angle)));
        const auto x = static_cast<float>(std::cos(angle));
        CHECK(std::fabs(upperAngle(y, x) - std::atan2(double(y), double(x))) < 4e-7);
    }
    CHECK(upperAngle(0.0f, 1.0f) == 0.0f);
    CHECK(upperAngle(0.0f, -1.0f) == kPi);
    CHECK(std::isfinite(upperAngle(0.0f, 0.0f)));
}

TEST_CASE("spherical rectangle: the solid angle is that of the closed form", "[sampling]")
{
    for (const Case& c : kCases)
    {
        const SphericalRectangle r = sphericalRectangle(c.x0, c.y0, c.width, c.height, c.z);
        const double exact = solidAngle(r.x0, r.x1, r.y0, r.y1, std::fabs(c.z));
        CAPTURE(c.name, exact, r.solidAngle);
        CHECK(std::fabs(r.solidAngle - exact) < 2e-6);
    }
    // In the plane of the rectangle: nothing from outside, half of all directions from inside.
    CHECK(std::fabs(sphericalRectangle(1.0f, 1.0f, 1.0f, 1.0f, 0.0f).solidAngle) < 2e-6f);
    CHECK(sphericalRectangle(-1.0f, -1.0f, 2.0f, 2.0f, 0.0f).solidAngle ==
          Approx(2.0f * kPi).margin(2e-6));
}

TEST_CASE("spherical rectangle: directions are uniform in solid angle", "[sampling][statistics]")
{
    constexpr int kSamples = 400000;
    constexpr std::size_t kCells = 12;
    const double threshold = sidak(0.001, int(std::size(kCases)));
    for (const Case& c : kCases)
    {
        const SphericalRectangle r = sphericalRectangle(c.x0, c.y0, c.width, c.height, c.z);
        const double z = std::fabs(double(c.z)), width = double(c.width) / kCells,
                     height = double(c.height) / kCells;
        const double whole = solidAngle(r.x0, r.x1, r.y0, r.y1, z);
        std::vector<double> observed(kCells * kCells, 0.0), expected;
        Uniform random(17);
        int outside = 0;
        for (int k = 0; k < kSamples; ++k)
        {
            float x, y;
            const float u = random(), v = random();
            squareToSphericalRectangle(r, u, v, x, y);
            outside += !(x >= r.x0 && x <= r.x1 && y >= r.y0 && y <= r.y1);
            const auto cell = [](double at)
            { return static_cast<std::size_t>(std::clamp(at, 0.0, kCells - 0.5)); };
            ++observed[cell((x - r.x0) / width) * kCells + cell((y - r.y0) / height)];
        }
        for (std::size_t i = 0; i < kCells; ++i)
            for (std::size_t j = 0; j < kCells; ++j)
            {
                const double x = r.x0 + width * double(i), y = r.y0 + height * double(j);
                expected.push_back(kSamples * solidAngle(x, x + width, y, y + height, z) / whole);
            }
        CAPTURE(c.name);
        CHECK(outside == 0);
        CHECK(chiSquareTest(observed, expected) > threshold);
    }
}

TEST_CASE("spherical rectangle: the corners of the square are those of the rectangle", "[sampling]")
{
    for (const Case& c : kCases)
    {
        const SphericalRectangle r = sphericalRectangle(c.x0, c.y0, c.width, c.height, c.z);
        for (const float u : {0.0f, kOneMinusEpsilon})
            for (const float v : {0.0f, kOneMinusEpsilon})
            {
                float x, y;
                squareToSphericalRectangle(r, u, v, x, y);
                // The share of the solid angle that is left of the point, and that below it.
                const double z = std::fabs(c.z);
                const double whole = solidAngle(r.x0, r.x1, r.y0, r.y1, z);
                const double share = solidAngle(r.x0, x, r.y0, r.y1, z) / whole;
                CAPTURE(c.name, u, v, x, y);
                CHECK(std::fabs(share - u) < 5e-5);
                const double below = solidAngle(r.x0, r.x1, r.y0, y, z) / whole;
                CHECK(std::fabs(below - v) < 5e-4);
            }
    }
}
