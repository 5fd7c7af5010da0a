// ClearCoatTest.cpp - clear coats with a normal of their own. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/shading/BsdfDensity.h"
#include "tests/shading/BsdfKinds.h"
#include "tests/shading/LatticeEstimate.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/LayeredBsdf.h"

#include <glm/gtc/constants.hpp>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 directionOf(double cosine, double phi)
{
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return Vec3(sine * std::cos(phi), sine * std::sin(phi), cosine);
}

/// Returns a kind whose coat is turned by an angle, towards an azimuth.
BsdfKind tilted(BsdfKind kind, double degrees, double azimuth)
{
    kind.name += ", coat turned by " + std::to_string(degrees);
    kind.bsdf.coatTilted = true;
    kind.bsdf.coatNormal = directionOf(std::cos(glm::radians(degrees)), azimuth);
    kind.bsdf.baseAverage = baseAverageOf(kind.bsdf);
    return kind;
}

/// Returns white kinds below coats of several roughnesses that are turned by 5 to 35 degrees; glass
/// from outside and from inside.
std::vector<BsdfKind> tiltedKinds()
{
    std::vector<BsdfKind> kinds;
    for (const float roughness : {0.0f, 0.3f, 0.8f})
        for (const auto& [name, base, metallic, transmission] :
             {std::tuple("plastic", 0.5f, 0.0f, 0.0f), std::tuple("metal", 0.4f, 1.0f, 0.0f),
              std::tuple("glass", 0.4f, 0.0f, 1.0f), std::tuple("half clear", 0.3f, 0.0f, 0.5f)})
        {
            Material material;
            material.model = MaterialModel::Physical;
            material.roughness = base;
            material.metallic = metallic;
            material.transmission = transmission;
            MaterialDetail detail;
            detail.clearcoat = 0.9f;
            detail.clearcoatRoughness = roughness;
            if (roughness == 0.8f) detail.sheenColor = Vec3(0.4f);
            if (roughness == 0.3f) detail.anisotropy = 0.6f;
            detail.anisotropyRotation = 0.8f;
            material.detail = std::make_shared<MaterialDetail>(detail);
            const std::string words = name + std::string(" below a coat of roughness ");
            for (const BsdfKind& kind : kindsOf(words + std::to_string(roughness), material))
                for (const double degrees : {5.0, 35.0})
                    kinds.push_back(tilted(kind, degrees, 0.3));
        }
    return kinds;
}

/// Returns the share of light that is scattered to the eye in an even white room.
Estimate albedoOf(const Bsdf& bsdf, Vec3 wo, int samples, uint32_t seed)
{
    const auto weight = [&](float uLobe, float u, float v)
    {
        const std::optional<BsdfSample> sample = sampleBsdf(bsdf, wo, uLobe, u, v);
        // Radiance is larger in the denser body by the square of the index.
        const float eta = bsdf.transmittedEta();
        const float scale = sample && sample->transmitted ? eta * eta : 1.0f;
        return sample ? double(sample->weight.y * scale) : 0.0;
    };
    return latticeEstimate(samples, seed, weight);
}

} // namespace

TEST_CASE("coat normal: samples follow the density of evalBsdf", "[shading][statistics][long]")
{
    const std::vector<BsdfKind> kinds = tiltedKinds();
    const std::vector<Vec3> directions = {directionOf(0.9, 0.7), directionOf(0.4, 3.5)};
    std::vector<DensityResult> results(kinds.size() * directions.size());
    Workers().forEach(results.size(),
                      [&](std::size_t i)
                      {
                          results[i] = testDensity(kinds[i / directions.size()].bsdf,
                                                   directions[i % directions.size()],
                                                   static_cast<uint32_t>(i), 40000);
                      });
    const double significance = sidak(0.01, static_cast<int>(results.size()));
    for (std::size_t i = 0; i < results.size(); ++i)
    {
        const DensityResult& result = results[i];
        CAPTURE(kinds[i / directions.size()].name, directions[i % directions.size()].z);
        CHECK(result.fit > significance);
        CHECK(result.withoutDensity < 5);
        CHECK(result.inconsistent == 0);
        CHECK(result.bad == 0);
        CHECK(result.total < 1.0 + 1e-3);
    }
}

TEST_CASE("coat normal: no surface makes energy, and a white base gets what the coat leaves",
          "[shading][statistics]")
{
    for (const BsdfKind& kind : tiltedKinds())
        for (const double cosine : {1.0, 0.7, 0.3, 0.1, 0.02})
            for (const double azimuth : {0.3, 3.4})
            {
                const Estimate share = albedoOf(kind.bsdf, directionOf(cosine, azimuth), 6400, 2);
                CAPTURE(kind.name, cosine, azimuth, share.mean(), share.standardError());
                CHECK(share.mean() < 1.002 + 4.0 * share.standardError());
            }
    // What a smooth coat mirrors below the horizon of the base is lost, and nothing else.
    Material white;
    white.model = MaterialModel::Physical;
    white.ior = 1.0f;
    MaterialDetail detail;
    detail.clearcoat = 1.0f;
    white.detail = std::make_shared<MaterialDetail>(detail);
    for (const double degrees : {1.0, 10.0, 30.0})
    {
        const Bsdf bsdf = tilted(kindsOf("", white).front(), degrees, 0.0).bsdf;
        for (const double cosine : {1.0, 0.8, 0.6})
        {
            const Estimate share = albedoOf(bsdf, directionOf(cosine, M_PI), 32000, 3);
            CAPTURE(degrees, cosine, share.mean());
            const Vec3 wo = directionOf(cosine, M_PI), n = bsdf.coatNormal;
            const bool lost = 2.0f * glm::dot(wo, n) * n.z - wo.z <= 0.0f;
            const double coat = fresnelDielectric(glm::dot(wo, n), 1.5f);
            CHECK(share.agrees(lost ? 1.0 - coat : 1.0, 2e-3));
        }
    }
}

TEST_CASE("coat normal: photons scatter as the adjoint of radiance", "[shading]")
{
    Uniform random(5);
    int compared = 0;
    for (const BsdfKind& kind : tiltedKinds())
        for (int i = 0; i < 200; ++i)
        {
            const Vec3 a = directionOf(0.02 + 0.98 * random(), 6.28 * random());
            const Vec3 b = directionOf(0.02 + 0.98 * random(), 6.28 * random());
            const Vec3 radiance = evalBsdf(kind.bsdf, a, b, Transport::Radiance).fCos / b.z;
            const Vec3 photons = evalBsdf(kind.bsdf, b, a, Transport::Importance).fCos / a.z;
            CAPTURE(kind.name, a.z, b.z);
            CHECK(photons.y == Approx(radiance.y).epsilon(2e-3).margin(1e-6));
            compared += radiance.y > 1e-4f;
        }
    CHECK(compared > 1000);
}

TEST_CASE("coat normal: a coat that is hardly turned is the coat of the surface", "[shading]")
{
    Uniform random(7);
    for (const float roughness : {0.0f, 0.4f})
    {
        Material white;
        white.model = MaterialModel::Physical;
        white.roughness = 0.3f;
        MaterialDetail detail;
        detail.clearcoat = 1.0f;
        detail.clearcoatRoughness = roughness;
        white.detail = std::make_shared<MaterialDetail>(detail);
        const BsdfKind plain = kindsOf("", white).front();
        const Bsdf turned = tilted(plain, 0.01, 1.0).bsdf;
        CHECK(turned.baseAverage == Approx(plain.bsdf.baseAverage).epsilon(1e-3));
        for (int i = 0; i < 100; ++i)
        {
            const Vec3 a = directionOf(0.05 + 0.95 * random(), 6.28 * random());
            const Vec3 b = directionOf(0.05 + 0.95 * random(), 6.28 * random());
            const BsdfValue before = evalBsdf(plain.bsdf, a, b), after = evalBsdf(turned, a, b);
            CHECK(after.fCos.y == Approx(before.fCos.y).epsilon(0.01));
            CHECK(after.pdfW == Approx(before.pdfW).epsilon(0.01));
        }
    }
}

TEST_CASE("coat normal: a smooth coat mirrors around its own normal", "[shading]")
{
    Material black;
    black.model = MaterialModel::Physical;
    black.baseColor = Vec3(0.0f);
    black.ior = 1.0f;
    MaterialDetail detail;
    detail.clearcoat = 1.0f;
    black.detail = std::make_shared<MaterialDetail>(detail);
    const Bsdf bsdf = tilted(kindsOf("", black).front(), 20.0, 0.0).bsdf;
    const SpecularLobes lobes = specularLobes(bsdf, Vec3(0, 0, 1));
    CHECK(lobes.reflection == Vec3(0.0f));
    CHECK(glm::length(lobes.coatMirrored - directionOf(std::cos(glm::radians(40.0)), 0.0)) < 1e-5f);
    const float fresnel = fresnelDielectric(static_cast<float>(std::cos(glm::radians(20.0))), 1.5f);
    CHECK(lobes.coat.y == Approx(fresnel).epsilon(1e-5));
    const auto sample = sampleBsdf(bsdf, Vec3(0, 0, 1), 0.5f, 0.3f, 0.7f);
    REQUIRE(sample);
    CHECK(sample->delta);
    CHECK(glm::length(sample->wi - lobes.coatMirrored) < 1e-5f);
    CHECK(sample->weight.y == Approx(fresnel).epsilon(1e-5));
    // A coat that would mirror below the horizon, or turns from the eye, sends nothing.
    CHECK(specularLobes(bsdf, directionOf(0.2, 0.0)).coat != Vec3(0.0f));
    CHECK(specularLobes(bsdf, directionOf(0.2, M_PI)).coat == Vec3(0.0f));
    CHECK_FALSE(sampleBsdf(bsdf, directionOf(0.2, M_PI), 0.5f, 0.3f, 0.7f));
}
