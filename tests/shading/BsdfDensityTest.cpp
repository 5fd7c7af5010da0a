// BsdfDensityTest.cpp - sampleBsdf has the density that evalBsdf claims.
// SPDX-License-Identifier: MIT
#include "tests/shading/BsdfDensity.h"
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/shading/BsdfKinds.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/shading/Fresnel.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Checks that the samples of each surface and direction fit their density, with 1 % false alarms
/// in all (Sidak).
void checkDensities(const std::vector<BsdfKind>& kinds, const std::vector<Vec3>& directions,
                    int samples)
{
    std::vector<DensityResult> results(kinds.size() * directions.size());
    Workers().forEach(results.size(),
                      [&](std::size_t i)
                      {
                          results[i] = testDensity(kinds[i / directions.size()].bsdf,
                                                   directions[i % directions.size()],
                                                   static_cast<uint32_t>(i), samples);
                      });
    const double significance = sidak(0.01, static_cast<int>(results.size()));
    for (std::size_t i = 0; i < results.size(); ++i)
    {
        const DensityResult& result = results[i];
        CAPTURE(kinds[i / directions.size()].name, directions[i % directions.size()].z);
        CHECK(result.fit > significance);
        CHECK(result.withoutDensity <
              5); // slivers of cells above the horizon, too thin for the quadrature
        CHECK(result.inconsistent == 0);
        CHECK(result.bad == 0);
        CHECK(result.total < 1.0 + 1e-3);
        // The discarded samples are what the density lacks to 1, within 5 sigma.
        const double spread = std::sqrt(result.total * std::max(1.0 - result.total, 0.0) / samples);
        CHECK(result.accepted == Approx(result.total).margin(5.0 * spread + 2e-4));
    }
}

} // namespace

TEST_CASE("bsdf: samples follow the density of evalBsdf, for every rough kind and angle",
          "[shading][statistics][long]")
{
    checkDensities(roughKinds(), outgoingDirections(), 200000);
}

TEST_CASE("bsdf: and at the ends of what a material can be", "[shading][statistics][long]")
{
    checkDensities(extremeKinds(), grazingDirections(), 200000);
}

TEST_CASE("bsdf: smooth lobes are chosen with the probability that they claim",
          "[shading][statistics]")
{
    std::vector<BsdfKind> kinds = smoothKinds();
    for (BsdfKind& kind : extremeSmoothKinds())
        kinds.push_back(kind);
    std::vector<Vec3> directions = outgoingDirections();
    for (const Vec3& wo : grazingDirections())
        directions.push_back(wo);
    for (const BsdfKind& kind : kinds)
    {
        for (const Vec3& wo : directions)
        {
            CAPTURE(kind.name, wo.z);
            // uLobe is stratified: frequencies are exact to 1/n.
            constexpr int kStrata = 4096;
            double reflected = 0.0, transmitted = 0.0, reflectedPmf = 0.0, transmittedPmf = 0.0;
            for (int i = 0; i < kStrata; ++i)
            {
                const std::optional<BsdfSample> sample =
                    sampleBsdf(kind.bsdf, wo, (static_cast<float>(i) + 0.5f) / kStrata, 0.3f, 0.6f);
                if (!sample || !sample->delta) continue;
                (sample->transmitted ? transmitted : reflected) += 1.0 / kStrata;
                (sample->transmitted ? transmittedPmf : reflectedPmf) = sample->pdfW;
                const SpecularLobes lobes = specularLobes(kind.bsdf, wo);
                const Vec3 lobe = sample->transmitted ? lobes.refraction : lobes.reflection;
                CHECK(glm::length(sample->weight * sample->pdfW - lobe) < 1e-6f);
                if (sample->transmitted)
                    CHECK(glm::length(sample->wi - lobes.refracted) < 1e-6f);
                else
                    CHECK(glm::length(sample->wi - Vec3(-wo.x, -wo.y, wo.z)) < 1e-6f);
            }
            CHECK(reflected == Approx(reflectedPmf).margin(1.5 / kStrata));
            CHECK(transmitted == Approx(transmittedPmf).margin(1.5 / kStrata));
        }
    }
}
