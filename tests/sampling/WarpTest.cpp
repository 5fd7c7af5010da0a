// WarpTest.cpp - maps of the square to directions have the density that they claim.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/sampling/Warp.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("sinCosTurn: within 2e-7 of the exact values", "[sampling]")
{
    double worst = 0.0;
    for (int i = 0; i <= 1000000; ++i)
    {
        const float turn = static_cast<float>(i) / 1000000.0f;
        float sine, cosine;
        sinCosTurn(turn, sine, cosine);
        const double angle = 2.0 * M_PI * double(turn);
        worst =
            std::max({worst, std::abs(sine - std::sin(angle)), std::abs(cosine - std::cos(angle))});
    }
    CHECK(worst < 2e-7);
}

TEST_CASE("cosine hemisphere: unit directions of density cos/pi", "[sampling][statistics]")
{
    // The tests are chi-square tests on 20 x 40 cells of equal probability, with 1e6 samples and 1
    // % false alarms.
    constexpr int kRows = 20, kColumns = 40, kSamples = 1000000;
    std::vector<double> counts(kRows * kColumns, 0.0);
    Uniform random(1);
    double worstLength = 0.0;
    for (int i = 0; i < kSamples; ++i)
    {
        const float u = random(), v = random();
        const Vec3 w = squareToCosineHemisphere(u, v);
        worstLength = std::max(worstLength, std::abs(glm::length(glm::dvec3(w)) - 1.0));
        double phi = std::atan2(double(w.y), double(w.x)) / (2.0 * M_PI);
        if (phi < 0.0) phi += 1.0;
        // The square of the cosine is uniform.
        const int row = std::min(kRows - 1, int(double(w.z) * w.z * kRows));
        const int column = std::min(kColumns - 1, int(phi * kColumns));
        ++counts[static_cast<std::size_t>(row * kColumns + column)];
    }
    CHECK(worstLength < 5e-7);
    CHECK(chiSquareTest(counts, std::vector<double>(counts.size(),
                                                    double(kSamples) / (kRows * kColumns))) > 0.01);
    CHECK(squareToCosineHemispherePdf(1.0f) == Approx(1.0 / M_PI));
    CHECK(squareToCosineHemispherePdf(-0.5f) == 0.0f);
    for (const float u : {0.0f, 0.25f, 0.999999f})
    {
        for (const float v : {0.0f, 0.5f, kOneMinusEpsilon})
        {
            const Vec3 w = squareToCosineHemisphere(u, v);
            CHECK(isFinite(w));
            CHECK(w.z >= 0.0f);
        }
    }
}

TEST_CASE("frameOf: orthonormal and right-handed, also next to the south pole", "[sampling]")
{
    Uniform random(2);
    std::vector<Vec3d> normals{{0, 0, 1},     {0, 0, -1},    {1, 0, 0},       {0, -1, 0},
                               {1e-6, 0, -1}, {0, 1e-4, -1}, {1e-3, 1e-3, -1}};
    for (int i = 0; i < 100000; ++i)
        normals.emplace_back(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    double worst = 0.0;
    for (const Vec3d& direction : normals)
    {
        if (glm::length(direction) < 1e-3) continue;
        const Vec3 n(glm::normalize(direction));
        Vec3 t, b;
        frameOf(n.x, n.y, n.z, t, b);
        const Vec3d nd(n), td(t), bd(b);
        worst = std::max({worst, std::abs(glm::dot(nd, td)), std::abs(glm::dot(nd, bd)),
                          std::abs(glm::dot(td, bd)), std::abs(glm::length(td) - 1.0),
                          std::abs(glm::length(bd) - 1.0), glm::length(glm::cross(td, bd) - nd)});
    }
    CHECK(worst < 1e-6);
}
