// EnvironmentMapTest.cpp - directions towards environments: distribution, poles, seam, extreme
// values.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Environments.h"
#include "tests/Statistics.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kFourPi = 4.0 * 3.14159265358979323846;

std::shared_ptr<EnvironmentImage> speckled(int width, int height, uint32_t seed)
{
    Uniform uniform(seed);
    const auto image = newEnvironment(width, height, Vec3(0.0f));
    for (Vec3& pixel : image->radiance)
        if (uniform() < 0.7f)
            pixel = Vec3(uniform(), uniform(), uniform()) * std::pow(10.0f, 3.0f * uniform());
    return image;
}

/// Returns the index of the pixel that a direction lies in, computed in double.
std::size_t pixelIndex(const EnvironmentImage& image, Vec3 d)
{
    const double turn = std::atan2(double(d.x), double(d.y)) / (2.0 * M_PI) + 0.5;
    const double height =
        std::atan2(double(d.z), std::hypot(double(d.x), double(d.y))) / M_PI + 0.5;
    const int x = std::min(static_cast<int>(turn * image.width), image.width - 1);
    const int y = std::min(static_cast<int>(height * image.height), image.height - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
}

} // namespace

TEST_CASE("environment map: samples are distributed as their density says",
          "[shading][statistics][stability 29]")
{
    constexpr int kSamples = 400000;
    const std::shared_ptr<EnvironmentImage> images[] = {
        speckled(32, 16, 1), speckled(37, 19, 2), speckled(1, 8, 3),
        speckled(40, 1, 4),  sunnySky(32, 16),    newEnvironment(1, 1, Vec3(2.0f))};
    const double threshold = sidak(0.001, 2 * int(std::size(images)));
    for (const auto& image : images)
        for (const EnvironmentDensity density :
             {EnvironmentDensity::Luminance, EnvironmentDensity::Compensated})
        {
            const EnvironmentMap map(image);
            const bool compensated = density == EnvironmentDensity::Compensated;
            if (compensated && map.isEven()) continue;
            // A pixel has a share by what it exceeds: nothing, or the mean over the sphere.
            const double floor = compensated ? map.luminanceIntegral() / kFourPi : 0.0;
            std::vector<double> observed(image->radiance.size()), expected(image->radiance.size());
            Uniform uniform(7);
            int elsewhere = 0;
            for (int k = 0; k < kSamples; ++k)
            {
                const EnvironmentSample sample = map.sample(uniform(), uniform(), density);
                REQUIRE(std::fabs(glm::length(sample.direction) - 1.0f) < 1e-6f);
                REQUIRE(sample.pdfW > 0.0f);
                ++observed[pixelIndex(*image, sample.direction)];
                // Rounding may put a direction beyond the border of its pixel.
                elsewhere += map.radiance(sample.direction) != sample.radiance;
                elsewhere += map.pdfW(sample.direction, density) != sample.pdfW;
            }
            double whole = 0.0, above = 0.0, strays = 0.0;
            for (int y = 0; y < image->height; ++y)
                for (int x = 0; x < image->width; ++x)
                {
                    const Vec3 middle(map.direction(x + 0.5, y + 0.5));
                    const double probability = map.pdfW(middle, density) * map.solidAngle(y);
                    const auto i = static_cast<std::size_t>(y * image->width + x);
                    const double excess = luminance(image->radiance[i]) - floor;
                    CHECK((probability > 0.0) == (excess > 0.0));
                    if (probability == 0.0) strays += observed[i];
                    whole += probability;
                    above += std::max(0.0, excess) * map.solidAngle(y);
                    expected[i] = std::max(0.0, excess) * map.solidAngle(y) * kSamples;
                }
            for (double& count : expected)
                count /= above;
            CAPTURE(image->width, image->height, compensated);
            CHECK(std::fabs(whole - 1.0) < 1e-5);
            CHECK(elsewhere < kSamples / 10000);
            CHECK(strays < kSamples / 10000);
            CHECK(chiSquareTest(observed, expected) > threshold);
        }
}

TEST_CASE("environment map: an even sky is left to rays that find it by chance", "[shading]")
{
    Uniform uniform(11);
    const auto nearlyEven = newEnvironment(64, 32, Vec3(0.7f));
    for (Vec3& pixel : nearlyEven->radiance)
        pixel *= 1.0f + 1e-6f * uniform();
    for (const auto& image : {newEnvironment(64, 32, Vec3(0.7f)), nearlyEven})
    {
        const EnvironmentMap map(image);
        CHECK(map.isEven());
        CHECK(map.sample(0.3f, 0.6f, EnvironmentDensity::Compensated).pdfW == 0.0f);
        CHECK(map.pdfW(Vec3(0, 0, 1), EnvironmentDensity::Compensated) == 0.0f);
        CHECK(map.sample(0.3f, 0.6f).pdfW * kFourPi == Approx(1.0).epsilon(1e-5));
    }
    CHECK_FALSE(EnvironmentMap(sunnySky(32, 16)).isEven());
}

TEST_CASE("environment map: within a pixel directions are uniform in solid angle",
          "[shading][statistics]")
{
    // A single pixel that reaches from a pole to 45 degrees below the equator is cut into cells of
    // equal solid angle.
    const EnvironmentMap map(
        newEnvironment(3, 2, [](Vec3d d) { return Vec3(d.z < 0.0 && d.y > 0.5 ? 1.0f : 0.0f); }));
    std::vector<double> observed(64), expected(64, 200000 / 64.0);
    Uniform uniform(3);
    for (int k = 0; k < 200000; ++k)
    {
        const Vec3 d = map.sample(uniform(), uniform()).direction;
        const double turn = std::atan2(d.x, d.y) / (2.0 * M_PI) * 3.0 + 0.5;
        const int column = std::clamp(static_cast<int>(turn * 8.0), 0, 7);
        const int row = std::clamp(static_cast<int>((d.z + 1.0f) * 8.0f), 0, 7);
        ++observed[static_cast<std::size_t>(row * 8 + column)];
    }
    CHECK(chiSquareTest(observed, expected) > 0.001);
}

TEST_CASE("environment map: a pixel of 1e9 leaves all dim ones their share",
          "[shading][statistics][stability 29]")
{
    const int width = 4096, height = 2048, sunX = 1234, sunY = 1500;
    const auto image = newEnvironment(width, height, Vec3(0.5f));
    pixelOf(*image, sunX, sunY) = Vec3(1e9f);
    const EnvironmentMap map(image);
    const double sun = 1e9 * map.solidAngle(sunY), sky = 0.5 * (kFourPi - map.solidAngle(sunY));
    CHECK(std::fabs(map.luminanceIntegral() / (sun + sky) - 1.0) < 1e-7);
    std::size_t reachable = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            reachable += map.pdfW(Vec3(map.direction(x + 0.5, y + 0.5))) > 0.0f;
    CHECK(reachable == image->radiance.size());

    constexpr int kSamples = 2000000;
    const double dim = sky / (sun + sky);
    Uniform uniform(5);
    std::vector<double> observed(32), expected(32, dim * kSamples / 32);
    int found = 0;
    for (int k = 0; k < kSamples; ++k)
    {
        const EnvironmentSample sample = map.sample(uniform(), uniform());
        if (sample.radiance.x > 1.0f) continue;
        ++found;
        const Vec3 d = sample.direction;
        const int column =
            std::clamp(static_cast<int>((std::atan2(d.x, d.y) / (2.0 * M_PI) + 0.5) * 8.0), 0, 7);
        const int row = std::clamp(static_cast<int>((d.z + 1.0f) * 2.0f), 0, 3);
        ++observed[static_cast<std::size_t>(row * 8 + column)];
    }
    // The count is Poisson distributed: 4 standard deviations, a false alarm in 16,000.
    CHECK(std::fabs(found - dim * kSamples) < 4.0 * std::sqrt(dim * kSamples));
    CHECK(chiSquareTest(observed, expected) > 0.001);
}

TEST_CASE("environment map: poles and seam", "[shading][stability 30]")
{
    const auto image = newEnvironment(8, 4, Vec3(1.0f));
    pixelOf(*image, 0, 2) = Vec3(2.0f);
    pixelOf(*image, 7, 2) = Vec3(3.0f);
    const EnvironmentMap map(image);
    for (const Vec3 pole :
         {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(-0.0f, -0.0f, 1), Vec3(0, -0.0f, -1)})
    {
        CHECK(map.radiance(pole) == Vec3(1.0f));
        CHECK(glm::length(map.interpolatedRadiance(pole) - Vec3(1.0f)) < 1e-6f);
    }
    // The seam is at -y: to the left of it, seen from inside, is the right border of the image.
    const Vec3 before = glm::normalize(Vec3(-1e-4f, -1.0f, 0.2f)),
               after = glm::normalize(Vec3(1e-4f, -1.0f, 0.2f));
    CHECK(map.radiance(before) == Vec3(2.0f));
    CHECK(map.radiance(after) == Vec3(3.0f));
    CHECK(map.radiance(Vec3(0.0f, -1.0f, 0.2f)).x >= 2.0f);
    CHECK(map.radiance(Vec3(-0.0f, -1.0f, 0.2f)).x >= 2.0f);
    const float step = map.interpolatedRadiance(before).x - map.interpolatedRadiance(after).x;
    CHECK(std::fabs(step) < 1e-3f);
    // Interpolation gives the pixels at their middles, and goes on over the poles.
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
        {
            const Vec3 there = map.interpolatedRadiance(Vec3(map.direction(x + 0.5, y + 0.5)));
            CHECK(glm::length(there - pixelOf(*image, x, y)) < 1e-5f);
        }
}

TEST_CASE("environment map: axes are as documented", "[shading]")
{
    const auto image = newEnvironment(8, 4, Vec3(0.0f));
    pixelOf(*image, 4, 2) = Vec3(1.0f); // right of the middle, above the horizon
    const EnvironmentMap map(image);
    CHECK(map.radiance(glm::normalize(Vec3(0.1f, 1.0f, 0.1f))) == Vec3(1.0f));
    CHECK(map.radiance(glm::normalize(Vec3(-0.1f, 1.0f, 0.1f))) == Vec3(0.0f));
    CHECK(map.radiance(glm::normalize(Vec3(0.1f, 1.0f, -0.1f))) == Vec3(0.0f));
    CHECK(map.radiance(glm::normalize(Vec3(0.1f, -1.0f, 0.1f))) == Vec3(0.0f));
}

TEST_CASE("environment map: black has nothing to sample, one pixel is a sphere",
          "[shading][stability 30]")
{
    const EnvironmentMap black(newEnvironment(16, 8, Vec3(0.0f)));
    CHECK(black.isBlack());
    CHECK(black.sample(0.5f, 0.5f).pdfW == 0.0f);
    CHECK(black.pdfW(Vec3(1, 0, 0)) == 0.0f);
    CHECK(black.radiance(Vec3(1, 0, 0)) == Vec3(0.0f));

    const EnvironmentMap sphere(newEnvironment(1, 1, Vec3(3.0f)));
    CHECK(std::fabs(sphere.integral().x - 3.0 * kFourPi) < 1e-6);
    CHECK(std::fabs(sphere.pdfW(Vec3(0, 0, 1)) * kFourPi - 1.0) < 1e-6);
    CHECK(sphere.interpolatedRadiance(glm::normalize(Vec3(1, 2, 3))) == Vec3(3.0f));
    // A sample without a valid direction is dropped, and does not read memory beside the image.
    CHECK(!isFinite(sphere.interpolatedRadiance(Vec3(NAN, 0.0f, 1.0f))));
    for (const float u : {0.0f, 0.5f, kOneMinusEpsilon})
        for (const float v : {0.0f, 0.5f, kOneMinusEpsilon})
            CHECK(isFinite(sphere.sample(u, v).direction));
}
