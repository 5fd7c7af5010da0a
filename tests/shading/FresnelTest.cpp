// FresnelTest.cpp - reflectances compared with known values and with a reference in double.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/ExactFresnel.h"

#include "osgRayTrace/shading/Bsdf.h"
#include "osgRayTrace/shading/Fresnel.h"

using namespace osgRayTrace::engine;
using osgRayTrace::engine::test::exactReflectance;

namespace
{

double radians(double degrees)
{
    return degrees * M_PI / 180.0;
}

float reflectance(double degrees, float eta)
{
    return fresnelDielectric(static_cast<float>(std::cos(radians(degrees))), eta);
}

} // namespace

TEST_CASE("fresnel: glass of index 1.5", "[shading]")
{
    CHECK(reflectance(0.0, 1.5f) == Approx(0.04));
    CHECK(reflectance(30.0, 1.5f) == Approx(0.04152263).epsilon(1e-5));
    CHECK(reflectance(60.0, 1.5f) == Approx(0.08918671).epsilon(1e-5));
    CHECK(reflectance(85.0, 1.5f) == Approx(0.61279965).epsilon(1e-5));
    // At Brewster's angle only one polarisation is reflected.
    const double brewster = 56.309932;
    const double s = std::sin(radians(2.0 * brewster - 90.0));
    CHECK(reflectance(brewster, 1.5f) == Approx(0.5 * s * s).epsilon(1e-5));
}

TEST_CASE("fresnel: the formula of the two polarisations for all angles and indices", "[shading]")
{
    for (const float eta :
         {1.01f, 1.33f, 1.5f, 2.4f, 1.0f / 1.33f, 1.0f / 1.5f, 1.0f / 2.4f, 10.0f})
    {
        for (int i = 0; i <= 1000; ++i)
        {
            const float cosine = static_cast<float>(i) / 1000.0f;
            CAPTURE(eta, cosine);
            REQUIRE(fresnelDielectric(cosine, eta) ==
                    Approx(exactReflectance(cosine, eta)).margin(2e-6).epsilon(2e-4));
        }
    }
}

TEST_CASE("fresnel: total reflection begins at the critical angle", "[shading]")
{
    const float eta = 1.0f / 1.5f;
    const double critical = 41.810315;
    for (const double above : {1e-5, 1e-3, 1.0})
        CHECK(reflectance(critical + above, eta) == Approx(1.0).margin(above < 1e-4 ? 3e-3 : 0.0));
    // The reflectance falls as the root of the distance: float cosines are 6e-8 apart, which is
    // 2e-3 at 1e-5 degrees and below 1e-4 from 1e-3 degrees on.
    CHECK(reflectance(critical - 1e-5, eta) ==
          Approx(exactReflectance(std::cos(radians(critical - 1e-5)), 1.0 / 1.5)).margin(3e-3));
    CHECK(reflectance(critical - 1e-2, eta) ==
          Approx(exactReflectance(std::cos(radians(critical - 1e-2)), 1.0 / 1.5)).margin(1e-4));
    CHECK_FALSE(
        refract(Vec3(std::sin(radians(41.82)), 0, std::cos(radians(41.82))), Vec3(0, 0, 1), eta));
    CHECK(refract(Vec3(std::sin(radians(41.80)), 0, std::cos(radians(41.80))), Vec3(0, 0, 1), eta));
}

TEST_CASE("fresnel: grazing incidence reflects everything, without NaN", "[shading][stability 35]")
{
    for (const float eta : {1.5f, 1.0f / 1.5f, 1.0001f, 100.0f})
    {
        CHECK(fresnelDielectric(0.0f, eta) == Approx(1.0));
        CHECK(std::isfinite(fresnelDielectric(1e-30f, eta)));
    }
    CHECK(reflectance(90.0 - 1e-4, 1.5f) == Approx(1.0).margin(1e-3));
}

TEST_CASE("fresnel: an index of 1, or nearly 1, reflects nothing", "[shading]")
{
    for (const float eta : {1.0f, 1.0f + 1.2e-7f, 1.0f - 1.2e-7f})
    {
        for (const double degrees : {0.0, 45.0, 80.0, 89.0})
            CHECK(reflectance(degrees, eta) < 1e-6f);
    }
}

TEST_CASE("fresnel: averages over diffuse incidence", "[shading]")
{
    CHECK(fresnelDielectricAverage(1.5f) == Approx(0.091778).margin(1e-4));
    CHECK(fresnelDielectricAverage(1.0f / 1.5f) == Approx(0.596346).margin(1e-4));
    CHECK(fresnelDielectricAverage(1.33f) == Approx(0.065931).margin(1e-4));
    CHECK(fresnelDielectricAverage(1.0f / 1.33f) == Approx(0.471949).margin(2e-4));
    CHECK(fresnelDielectricAverage(1.0f) == 0.0f);
}

TEST_CASE("fresnel: Schlick's curve goes from normal to grazing reflectance", "[shading]")
{
    CHECK(fresnelSchlick(1.0f, Vec3(0.1f, 0.5f, 0.9f), 1.0f) == Vec3(0.1f, 0.5f, 0.9f));
    CHECK(fresnelSchlick(0.0f, Vec3(0.1f, 0.5f, 0.9f), 0.8f) == Vec3(0.8f));
    CHECK(fresnelSchlick(0.5f, Vec3(0.0f), 1.0f).x == Approx(0.03125));
    CHECK(fresnelSchlick(1.0001f, Vec3(0.2f), 1.0f).x == Approx(0.2f));
}

TEST_CASE("refract: Snell's law, and the way back", "[shading]")
{
    for (const float eta : {1.5f, 1.0f / 1.5f, 2.4f, 1.0f})
    {
        for (const double degrees : {0.0, 10.0, 40.0})
        {
            const Vec3 wo(std::sin(radians(degrees)), 0.0, std::cos(radians(degrees)));
            const std::optional<Vec3> wi = refract(wo, Vec3(0, 0, 1), eta);
            if (!wi) continue;
            CAPTURE(eta, degrees);
            CHECK(glm::length(*wi) == Approx(1.0f));
            CHECK(wi->z < 0.0f);
            CHECK(wi->x * eta == Approx(-wo.x).margin(1e-6));
            const std::optional<Vec3> back = refract(*wi, Vec3(0, 0, -1), 1.0f / eta);
            REQUIRE(back);
            CHECK(glm::length(*back - wo) < 1e-5f);
        }
    }
}
