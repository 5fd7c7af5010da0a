// LightStepsTest.cpp - choices among the places of a step down a light tree.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/LightSteps.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr uint32_t kHas = ~0u;

int placeOf(const StepChoice& choice)
{
    return choice.is0 ? 0 : choice.is1 ? 1 : choice.is2 ? 2 : 3;
}

/// Returns a weight of any size that a float has, or 0.
float anyWeight(Uniform& random)
{
    if (random() < 0.4f) return 0.0f;
    return static_cast<float>(std::exp2(random.between(-149, 128)));
}

} // namespace

TEST_CASE("light steps: places are chosen in proportion to importances", "[shading]")
{
    const StepWeights weights = stepWeights({3.0f, 1.0f, 0.0f, 4.0f}, kHas, kHas);
    for (const auto& [u, place, left] :
         {std::tuple(0.0f, 0, 0.0f), std::tuple(0.1875f, 0, 0.5f), std::tuple(0.375f, 1, 0.0f),
          std::tuple(0.4375f, 1, 0.5f), std::tuple(0.5f, 3, 0.0f), std::tuple(0.875f, 3, 0.75f)})
    {
        const StepChoice choice = chooseStep(weights, u);
        CAPTURE(u);
        CHECK(placeOf(choice) == place);
        CHECK(choice.u == left);
        const float shares[] = {0.375f, 0.125f, 0.0f, 0.5f};
        CHECK(choice.probability == shares[place]);
    }
}

TEST_CASE("light steps: no number leads to a place that is dark or has no node", "[shading]")
{
    // Importances are of all sizes, and numbers are the largest one, 0 and others.
    Uniform random(11);
    int dark = 0;
    for (int i = 0; i < 200000; ++i)
    {
        const float w[4] = {anyWeight(random), anyWeight(random), anyWeight(random),
                            anyWeight(random)};
        const uint32_t has1 = random() < 0.7f ? kHas : 0, has3 = random() < 0.7f ? kHas : 0;
        const bool shines[4] = {w[0] > 0.0f, has1 && w[1] > 0.0f, w[2] > 0.0f, has3 && w[3] > 0.0f};
        const StepWeights weights = stepWeights({w[0], w[1], w[2], w[3]}, has1, has3);
        const bool isDark = !(shines[0] || shines[1] || shines[2] || shines[3]);
        dark += isDark;
        for (const float u : {kOneMinusEpsilon, 0.0f, random()})
        {
            const StepChoice choice = chooseStep(weights, u);
            const int place = placeOf(choice);
            const bool isRight = isDark ? place == 0 : shines[place];
            const bool isRange = choice.u >= 0.0f && choice.u < 1.0f;
            const bool isOne =
                !((choice.is0 & choice.is1) | ((choice.is0 | choice.is1) & choice.is2));
            if (!isRight || !isRange || !isOne || !(choice.probability > 0.0f))
                FAIL(w[0] << " " << w[1] << " " << w[2] << " " << w[3] << ", " << u << " -> "
                          << place << ", " << choice.u << ", " << choice.probability);
        }
    }
    CHECK(dark > 1000);
}

TEST_CASE("light steps: rounding takes the last chance of no node that shines", "[shading]")
{
    const StepWeights weights = stepWeights({1.0f, 1e-30f, kInfinity, 1e-12f}, kHas, kHas);
    const float sum = sumOf(weights);
    CHECK(weights.w1 / sum == Approx(0x1p-20).epsilon(1e-5));
    CHECK(weights.w3 / sum == Approx(0x1p-20).epsilon(1e-5));
    CHECK(weights.w0 / sum == Approx(0x1p-20).epsilon(1e-5));
    CHECK(weights.w2 / sum == Approx(1.0 - 3 * 0x1p-20).epsilon(1e-6));
}
