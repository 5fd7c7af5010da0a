// LayeredBsdfTest.cpp - layers follow their densities, keep energy and are reciprocal. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/shading/BsdfDensity.h"
#include "tests/shading/BsdfKinds.h"
#include "tests/shading/LatticeEstimate.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/LayeredBsdf.h"
#include "osgRayTrace/shading/Sheen.h"

#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 directionOf(double cosine, double phi)
{
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return Vec3(sine * std::cos(phi), sine * std::sin(phi), cosine);
}

Vec3 turned(Vec3 w)
{
    return Vec3(w.x, w.y, -w.z);
}

/// Returns the share of a photon's flux that is scattered.
Estimate albedoOf(const Bsdf& bsdf, double cosine, int samples, uint32_t seed, double phi = 0.4)
{
    const auto weight = [&](float uLobe, float u, float v)
    {
        const std::optional<BsdfSample> sample =
            sampleBsdf(bsdf, directionOf(cosine, phi), uLobe, u, v, Transport::Importance);
        return sample ? double(sample->weight.y) : 0.0;
    };
    return latticeEstimate(samples, seed, weight);
}

Material dielectric(float roughness, float transmission)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.roughness = roughness;
    material.transmission = transmission;
    return material;
}

Bsdf withDetail(Material material, const MaterialDetail& detail, bool front = true)
{
    material.detail = std::make_shared<MaterialDetail>(detail);
    const std::vector<BsdfKind> kinds = kindsOf("", material);
    return front ? kinds.front().bsdf : kinds.back().bsdf;
}

} // namespace

TEST_CASE("layers: samples follow the density of evalBsdf", "[shading][statistics][long]")
{
    const std::vector<BsdfKind> kinds = layeredKinds();
    const std::vector<Vec3> directions = {directionOf(0.9, 0.7), directionOf(0.2, 0.7)};
    std::vector<DensityResult> results(kinds.size() * directions.size());
    constexpr int kSamples = 40000;
    Workers().forEach(results.size(),
                      [&](std::size_t i)
                      {
                          results[i] = testDensity(kinds[i / directions.size()].bsdf,
                                                   directions[i % directions.size()],
                                                   static_cast<uint32_t>(i), kSamples);
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

TEST_CASE("layers: no surface makes energy, and lossless ones keep all", "[shading][statistics]")
{
    for (const BsdfKind& kind : layeredKinds())
        for (const double cosine : {1.0, 0.7, 0.3, 0.1, 0.02})
        {
            const Estimate share = albedoOf(kind.bsdf, cosine, 8000, 2);
            CAPTURE(kind.name, cosine, share.mean(), share.standardError());
            CHECK(share.mean() < 1.002 + 4.0 * share.standardError());
        }
    // A white base below smooth layers gets what they leave.
    MaterialDetail coated, dim, bright, both;
    coated.clearcoat = 0.7f;
    dim.specular = 0.3f;
    bright.specularColor = Vec3(6.0f);
    both = bright;
    both.clearcoat = 1.0f;
    for (const MaterialDetail& detail : {coated, dim, bright, both})
        for (const double cosine : {1.0, 0.5, 0.1})
        {
            const Estimate share =
                albedoOf(withDetail(dielectric(0.0f, 0.0f), detail), cosine, 32000, 3);
            CAPTURE(detail.clearcoat, detail.specular, cosine, share.mean());
            CHECK(share.agrees(1.0, 5e-4));
        }
    // A smooth wall loses nothing either.
    MaterialDetail thin;
    thin.thinWalled = true;
    CHECK(albedoOf(withDetail(dielectric(0.0f, 1.0f), thin), 0.5, 20000, 4).agrees(1.0, 1e-5));
}

TEST_CASE("layers: a white base makes no energy below brushed facets", "[shading][statistics]")
{
    // Cosines around .75, where total reflection ends within a body of index 1.5, and grazing ones.
    for (const float transmission : {0.0f, 0.05f, 0.5f})
        for (const float roughness : {0.0f, 0.1f, 0.5f})
        {
            MaterialDetail detail;
            detail.anisotropy = roughness < 0.2f ? 0.5f : 1.0f;
            const Bsdf bsdf =
                withDetail(dielectric(roughness, transmission), detail, transmission == 0.0f);
            for (const double cosine : {0.8, 0.77, 0.3, 0.03})
                for (const double phi : {0.0, 0.8, 1.57})
                {
                    const Estimate share = albedoOf(bsdf, cosine, 8000, 7, phi);
                    CAPTURE(transmission, roughness, cosine, phi, share.mean());
                    CHECK(share.mean() < 1.002 + 4.0 * share.standardError());
                }
        }
}

TEST_CASE("layers: reflection and thin walls are the same both ways", "[shading]")
{
    Uniform random(4);
    for (const BsdfKind& kind : layeredKinds())
    {
        CAPTURE(kind.name);
        for (int i = 0; i < 500; ++i)
        {
            const Vec3 a = directionOf(random.between(0.01, 1.0), random.between(0.0, 6.28));
            const Vec3 b = directionOf(random.between(0.01, 1.0), random.between(0.0, 6.28));
            const Vec3 ab = evalBsdf(kind.bsdf, a, b).fCos / b.z;
            const Vec3 ba = evalBsdf(kind.bsdf, b, a).fCos / a.z;
            REQUIRE(glm::length(ab - ba) <= 2e-3f * glm::length(ab) + 1e-5f);
            const bool leaf = kind.bsdf.passesLight() && !kind.bsdf.transmits();
            if (!kind.bsdf.thin && !leaf) continue;
            const Vec3 through = evalBsdf(kind.bsdf, a, turned(b)).fCos / b.z;
            const Vec3 back = evalBsdf(kind.bsdf, b, turned(a)).fCos / a.z;
            REQUIRE(glm::length(through - back) <= 2e-3f * glm::length(through) + 1e-5f);
        }
    }
}

TEST_CASE("layers: refraction under a coat is its adjoint from inside", "[shading]")
{
    MaterialDetail detail;
    detail.clearcoat = 0.8f;
    detail.sheenColor = Vec3(0.5f);
    detail.specular = 0.9f;
    const Bsdf near = withDetail(dielectric(0.5f, 1.0f), detail);
    const Bsdf far = withDetail(dielectric(0.5f, 1.0f), detail, false);
    REQUIRE(far.inside);
    Uniform random(5);
    int compared = 0;
    for (int i = 0; i < 4000; ++i)
    {
        const Vec3 wo = directionOf(random.between(0.05, 1.0), random.between(0.0, 6.28));
        const auto sample = sampleBsdf(near, wo, random.between(0.5, 1.0), random(), random());
        if (!sample || !sample->transmitted || sample->wi.z > -0.05f) continue;
        const float radiance = evalBsdf(near, wo, sample->wi).fCos.x / -sample->wi.z;
        const float importance =
            evalBsdf(far, turned(sample->wi), turned(wo), Transport::Importance).fCos.x / wo.z;
        REQUIRE(importance == Approx(radiance).epsilon(2e-2));
        ++compared;
    }
    CHECK(compared > 500);
}

TEST_CASE("layers: without effect they are the surface without layers", "[shading]")
{
    Uniform random(6);
    for (const float transmission : {0.0f, 0.5f})
        for (const bool front : {true, false})
        {
            Bsdf plain = withDetail(dielectric(0.4f, transmission), {}, front);
            REQUIRE_FALSE(plain.layered);
            Bsdf layered = plain;
            layered.layered = true;
            layered.inside = !front && transmission > 0.0f;
            const float root = (plain.eta - 1.0f) / (plain.eta + 1.0f);
            layered.normalReflectance = Vec3(root * root);
            layered.baseAverage = baseAverageOf(layered);
            for (int i = 0; i < 1000; ++i)
            {
                const Vec3 wo = directionOf(random.between(0.05, 1.0), random.between(0.0, 6.28));
                const Vec3 wi = directionOf(random.between(-1.0, 1.0), random.between(0.0, 6.28));
                const BsdfValue a = evalBsdf(plain, wo, wi), b = evalBsdf(layered, wo, wi);
                CAPTURE(transmission, front, wo.z, wi.z);
                REQUIRE(b.fCos.y == Approx(a.fCos.y).epsilon(2e-3).margin(1e-6));
            }
        }
}

TEST_CASE("layers: a pane passes (1-R)/(1+R) straight, and tints it", "[shading]")
{
    MaterialDetail detail;
    detail.thinWalled = true;
    Material green = dielectric(0.0f, 1.0f);
    green.baseColor = Vec3(0.25f, 1.0f, 0.5f);
    const Bsdf pane = withDetail(green, detail);
    for (const double degrees : {0.0, 60.0})
    {
        const double cosine = std::cos(degrees * M_PI / 180.0);
        const double r = fresnelDielectric(static_cast<float>(cosine), 1.5f);
        const Vec3 wo = directionOf(cosine, 1.0);
        const SpecularLobes lobes = specularLobes(pane, wo);
        CHECK(glm::length(lobes.refracted + wo) < 1e-6f);
        CHECK(lobes.refraction.y == Approx((1.0 - r) / (1.0 + r)).epsilon(1e-5));
        CHECK(lobes.refraction.x == Approx(0.25f * lobes.refraction.y).epsilon(1e-5));
        CHECK(lobes.reflection.y == Approx(2.0 * r / (1.0 + r)).epsilon(1e-5));
        CHECK(straightTransmittance(pane, static_cast<float>(cosine)).y ==
              Approx(lobes.refraction.y));
    }
}

TEST_CASE("layers: brushed facets reflect by the widths along and across", "[shading]")
{
    MaterialDetail brushed;
    brushed.anisotropy = 0.5f;
    Material metal = dielectric(0.6f, 0.0f);
    metal.metallic = 1.0f;
    const double across = 0.36, along = across + (1.0 - across) * 0.25;
    for (const double turn : {0.0, 0.5 * M_PI, 1.1})
    {
        brushed.anisotropyRotation = static_cast<float>(turn);
        const Bsdf bsdf = withDetail(metal, brushed);
        REQUIRE(bsdf.isAnisotropic());
        const Vec3 up(0, 0, 1);
        CHECK(evalBsdf(bsdf, up, up).fCos.y ==
              Approx(0.25 / (M_PI * along * across)).epsilon(1e-5));
        for (const double degrees : {10.0, 30.0, 60.0})
        {
            // Light from the side of a direction, seen from above: the facets are half as tilted.
            const double angle = degrees * M_PI / 180.0, half = 0.5 * angle;
            for (const bool isAlong : {true, false})
            {
                const double width = isAlong ? along : across;
                const double phi = turn + (isAlong ? 0.0 : 0.5 * M_PI);
                const double x = std::sin(half) / width, z = std::cos(half);
                const double d = 1.0 / (M_PI * along * across * std::pow(x * x + z * z, 2));
                const double lambda =
                    0.5 * (std::sqrt(1.0 + std::pow(width * std::tan(angle), 2)) - 1.0);
                const Vec3 wi = directionOf(std::cos(angle), phi);
                CAPTURE(turn, degrees, isAlong);
                CHECK(evalBsdf(bsdf, up, wi).fCos.y ==
                      Approx(d / (1.0 + lambda) / 4.0).epsilon(1e-4));
            }
        }
    }
}

TEST_CASE("layers: equal widths along and across are one width", "[shading]")
{
    Uniform random(8);
    const GgxWidths equal{0.3f, 0.3f}, nearly{0.3f, 0.300001f};
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 wo = directionOf(random.between(0.05, 1.0), random.between(0.0, 6.28));
        const Vec3 wi = directionOf(random.between(0.05, 1.0), random.between(0.0, 6.28));
        const float u = random(), v = random();
        CHECK(evalGgx(wi, equal) == evalGgx(wi, 0.3f));
        CHECK(evalGgx(wi, nearly) == Approx(evalGgx(wi, 0.3f)).epsilon(1e-4));
        CHECK(ggxG2(wo, wi, nearly) == Approx(ggxG2(wo, wi, 0.3f)).epsilon(1e-4));
        CHECK(glm::length(sampleGgxVisible(wo, nearly, u, v) - sampleGgxVisible(wo, 0.3f, u, v)) <
              1e-4f);
    }
}

TEST_CASE("layers: a rough film over a white base of any index makes no energy",
          "[shading][statistics]")
{
    // At these thicknesses a film over air is darkest along the normal, and rough facets turn from
    // there: see filmRise.
    const struct
    {
        float roughness, film, thickness;
    } kinds[] = {
        {0.4f, 1.8f, 450.0f}, {0.4f, 1.5f, 550.0f}, {0.4f, 1.3f, 630.0f}, {1.0f, 2.0f, 180.0f}};
    for (const auto& kind : kinds)
        for (const float ior : {1.0f, 1.02f, 1.5f})
            for (const double cosine : {1.0, 0.8, 0.5, 0.2})
            {
                MaterialDetail detail;
                detail.iridescence = 1.0f;
                detail.iridescenceIor = kind.film;
                detail.iridescenceThickness = Vec2(kind.thickness);
                Material white = dielectric(kind.roughness, 0.0f);
                white.ior = ior;
                const Bsdf bsdf = withDetail(white, detail);
                double most = 0.0, spread = 0.0;
                for (int c = 0; c < 3; ++c)
                {
                    const auto weight = [&](float uLobe, float u, float v)
                    {
                        const auto sample = sampleBsdf(bsdf, directionOf(cosine, 0.4), uLobe, u, v);
                        return sample ? double(sample->weight[c]) : 0.0;
                    };
                    const Estimate share = latticeEstimate(9600, 3, weight);
                    most = std::max(most, share.mean());
                    spread = std::max(spread, share.standardError());
                }
                CAPTURE(ior, kind.film, kind.roughness, kind.thickness, cosine, most, spread);
                CHECK(most < 1.002 + 4.0 * spread);
                CHECK((most > 0.6 || ior == 1.02f)); // the bound takes light from the base
            }
}

TEST_CASE("layers: a white leaf keeps all light, and sends its share to the other side",
          "[shading][statistics]")
{
    MaterialDetail leaf;
    leaf.diffuseTransmission = 0.75f;
    leaf.diffuseTransmissionColor = Vec3(1.0f, 1.0f, 0.5f);
    for (const bool front : {true, false})
    {
        const Bsdf bsdf = withDetail(dielectric(0.0f, 0.0f), leaf, front);
        CHECK(bsdf.transmittedEta() == 1.0f);
        for (const double cosine : {1.0, 0.5, 0.1})
        {
            CHECK(albedoOf(bsdf, cosine, 32000, 3).agrees(1.0, 5e-4));
            const float f = fresnelDielectric(static_cast<float>(cosine), 1.5f);
            Estimate through, blue;
            Uniform random(9);
            for (int i = 0; i < 50000; ++i)
            {
                const float uLobe = random(), u = random(), v = random();
                const auto sample = sampleBsdf(bsdf, directionOf(cosine, 0.4), uLobe, u, v);
                const bool passed = sample && sample->transmitted;
                through.add(passed ? sample->weight.y : 0.0);
                blue.add(passed ? sample->weight.z : 0.0);
            }
            CAPTURE(cosine, through.mean());
            CHECK(through.agrees(0.75 * (1.0 - f), 1e-3));
            CHECK(blue.agrees(0.375 * (1.0 - f), 1e-3));
        }
    }
}

TEST_CASE("layers: the table of sheen is the integral of its lobe, or 1 if that is more",
          "[shading]")
{
    for (const float roughness : {0.1f, 0.13f, 0.3f, 0.6f, 1.0f})
        for (const float cosine : {1.0f, 0.6f, 0.2f, 0.05f, 0.005f})
        {
            const Vec3 wo = directionOf(cosine, 0.0);
            constexpr int kSteps = 150; // the midpoint rule in the square root of the cosine
            double integral = 0.0;
            for (int k = 0; k < kSteps * kSteps; ++k)
            {
                const double x = (k / kSteps + 0.5) / kSteps;
                const Vec3 wi = directionOf(x * x, M_PI * (k % kSteps + 0.5) / kSteps);
                integral += evalSheen(roughness * roughness, wo, wi) * wi.z * 2.0 * x;
            }
            integral *= 2.0 * M_PI / (kSteps * kSteps);
            const double albedo = sheenAlbedo(roughness * roughness, cosine);
            CAPTURE(roughness, cosine, integral, albedo);
            CHECK(integral < 1.0);
            CHECK(albedo == Approx(integral).margin(integral > 0.9 ? 0.08 : 0.025));
            CHECK(integral + 1.0 - albedo < 1.005); // what a white base below it has at most
        }
}

TEST_CASE("layers: a specular colour changes what is reflected at normal incidence", "[shading]")
{
    MaterialDetail detail;
    detail.specular = 0.5f;
    detail.specularColor = Vec3(2.0f, 1.0f, 100.0f);
    const SpecularLobes lobes =
        specularLobes(withDetail(dielectric(0.0f, 0.0f), detail), Vec3(0, 0, 1));
    CHECK(lobes.reflection.x == Approx(0.5f * 0.08f).epsilon(1e-4));
    CHECK(lobes.reflection.y == Approx(0.5f * 0.04f).epsilon(1e-4));
    CHECK(lobes.reflection.z == Approx(0.5f).epsilon(1e-4));
}
