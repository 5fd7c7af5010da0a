// EnvironmentStrataTest.cpp - structured importance sampling keeps the light, and strata are where
// the light is.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/EnvironmentStrata.h"

#include "tests/Catch.h"
#include "tests/Environments.h"
#include "tests/Statistics.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3d sumOf(const std::vector<EnvironmentStratum>& strata)
{
    Vec3d sum(0.0);
    for (const EnvironmentStratum& stratum : strata)
        sum += Vec3d(stratum.integral);
    return sum;
}

double irradiance(const std::vector<EnvironmentStratum>& strata, Vec3d normal)
{
    double sum = 0.0;
    for (const EnvironmentStratum& stratum : strata)
        sum += stratum.integral.y * std::max(0.0, glm::dot(Vec3d(stratum.direction), normal));
    return sum;
}

/// Returns the irradiance by the middles of pixels, which is right to 1e-3 for 256 x 128 pixels.
double irradiance(const EnvironmentMap& map, Vec3d normal)
{
    const EnvironmentImage& image = *map.image();
    double sum = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            sum += image.radiance[static_cast<std::size_t>(y * image.width + x)].y *
                   map.solidAngle(y) *
                   std::max(0.0, glm::dot(map.direction(x + 0.5, y + 0.5), normal));
    return sum;
}

Vec3d randomDirection(Uniform& uniform)
{
    const double z = uniform.between(-1.0, 1.0), turn = uniform.between(0.0, 2.0 * M_PI);
    const double across = std::sqrt(1.0 - z * z);
    return Vec3d(across * std::cos(turn), across * std::sin(turn), z);
}

} // namespace

TEST_CASE("strata: their number is the one wanted and they hold all light", "[shading]")
{
    for (const auto& image :
         {sunnySky(64, 32), sunnySky(1100, 300), newEnvironment(31, 17, Vec3(1, 2, 3))})
    {
        const EnvironmentMap map(image);
        for (const int count : {1, 2, 7, 300})
        {
            const auto strata = environmentStrata(map, count);
            CAPTURE(image->width, count);
            CHECK(int(strata.size()) == count);
            CHECK(glm::length(sumOf(strata) / map.integral() - Vec3d(1.0)) < 1e-5);
            for (const EnvironmentStratum& stratum : strata)
                CHECK(std::fabs(glm::length(stratum.direction) - 1.0f) < 1e-5f);
        }
    }
}

TEST_CASE("strata: coarse images are cut up, none of black pixels", "[shading][stability 30]")
{
    CHECK(environmentStrata(EnvironmentMap(newEnvironment(64, 32, Vec3(0.0f))), 300).empty());
    for (const auto& image : {newEnvironment(1, 1, Vec3(1.0f)), newEnvironment(3, 2, Vec3(1.0f))})
    {
        const auto strata = environmentStrata(EnvironmentMap(image), 300);
        CHECK(strata.size() == 300);
        CHECK(std::fabs(irradiance(strata, Vec3d(0, 0, 1)) / M_PI - 1.0) < 0.01);
        CHECK(std::fabs(irradiance(strata, Vec3d(0.6, 0, -0.8)) / M_PI - 1.0) < 0.01);
    }
    // There are 4 x 4 cells of one pixel, all of them within it.
    const auto image = newEnvironment(64, 32, Vec3(0.0f));
    pixelOf(*image, 10, 20) = Vec3(5.0f);
    const EnvironmentMap map(image);
    const auto strata = environmentStrata(map, 300);
    CHECK(strata.size() == 16);
    for (const EnvironmentStratum& stratum : strata)
        CHECK(map.radiance(stratum.direction) == Vec3(5.0f));
    const auto one = environmentStrata(map, 1);
    REQUIRE(one.size() == 1);
    CHECK(glm::length(Vec3d(one[0].direction) - map.direction(10.5, 20.5)) <
          1e-3); // it is 0.1 wide, and its mean is not in its middle
}

TEST_CASE("strata: the sun has its own, where it is, and no light but its own", "[shading]")
{
    for (const int width : {64, 256, 4096})
    {
        const auto image = sunnySky(width, width / 2);
        const EnvironmentMap map(image);
        const Vec3d sun = map.direction(width * 5 / 8 + 0.5, width / 2 * 3 / 4 + 0.5);
        double share = 0.0;
        int count = 0;
        for (const EnvironmentStratum& stratum : environmentStrata(map, 300))
        {
            if (glm::length(Vec3d(stratum.direction) - sun) > 4.0 / width) continue;
            share += luminance(stratum.integral) / map.luminanceIntegral();
            ++count;
        }
        CAPTURE(width, share);
        CHECK(count == (width == 64 ? 16 : 1));
        CHECK(std::fabs(share - 0.5) < 0.005);
    }
}

TEST_CASE("strata: regions do not end at the seam or at a pole", "[shading]")
{
    // A disc below 0.01 sr has as much light as the rest: cut in two halves it would count for
    // less, 2^(-1/4) times its importance, which is four strata.
    const auto inDisc = [](Vec3d centre)
    {
        const auto image = newEnvironment(
            512, 256,
            [centre](Vec3d d) { return Vec3(glm::dot(d, centre) > 0.9988 ? 1667.0f : 1.0f); });
        int count = 0;
        for (const EnvironmentStratum& stratum : environmentStrata(EnvironmentMap(image), 100))
            count += glm::dot(Vec3d(stratum.direction), centre) > 0.9988;
        return count;
    };
    const int elsewhere = inDisc(Vec3d(0, 1, 0));
    const int atSeam = inDisc(Vec3d(0, -1, 0)), zenith = inDisc(Vec3d(0, 0, 1)),
              nadir = inDisc(Vec3d(0, 0, -1));
    CAPTURE(elsewhere, atSeam, zenith, nadir);
    CHECK(elsewhere > 40);
    CHECK(std::abs(atSeam - elsewhere) <= 1);
    CHECK(std::abs(zenith - elsewhere) <= 2);
    CHECK(std::abs(nadir - elsewhere) <= 2);
}

TEST_CASE("strata: irradiance without occluders is near the exact one, nearer with more",
          "[shading]")
{
    const EnvironmentMap map(sunnySky(256, 128));
    double before = 1.0;
    for (const int count : {30, 300, 3000})
    {
        const auto strata = environmentStrata(map, count);
        Uniform uniform(11);
        double squares = 0.0, largest = 0.0;
        for (int k = 0; k < 200; ++k)
        {
            const Vec3d normal = randomDirection(uniform);
            const double error = irradiance(strata, normal) / irradiance(map, normal) - 1.0;
            squares += error * error;
            largest = std::max(largest, std::fabs(error));
        }
        const double rms = std::sqrt(squares / 200.0);
        CAPTURE(count, rms, largest);
        CHECK(rms < before);
        if (count == 300) CHECK(rms < 5e-3);
        if (count == 300) CHECK(largest < 2e-2);
        before = rms;
    }
}

TEST_CASE("strata: far apart, as Hochbaum and Shmoys's bound says", "[shading]")
{
    // For an even sky the centres are the farthest-point sequence: 100 points cover the sphere with
    // caps of at most twice the radius of the best covering. The best radius for 100 points is
    // 0.223 (half angle of caps of 4 pi / 100 times 1.24).
    const EnvironmentMap map(newEnvironment(128, 64, Vec3(1.0f)));
    const auto strata = environmentStrata(map, 100);
    REQUIRE(strata.size() == 100);
    Uniform uniform(13);
    double worst = 0.0;
    for (int k = 0; k < 5000; ++k)
    {
        const Vec3d d = randomDirection(uniform);
        double nearest = 10.0;
        for (const EnvironmentStratum& stratum : strata)
            nearest = std::min(
                nearest, std::acos(std::clamp(glm::dot(d, Vec3d(stratum.direction)), -1.0, 1.0)));
        worst = std::max(worst, nearest);
    }
    CAPTURE(worst);
    CHECK(worst < 2.0 * 0.2228);
    const double share = map.integral().x / 100.0;
    for (const EnvironmentStratum& stratum : strata)
        CHECK((stratum.integral.x > 0.2 * share && stratum.integral.x < 3.0 * share));
}
