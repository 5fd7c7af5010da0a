// BsdfEnergyTest.cpp - surfaces conserve energy, are reciprocal, and stay finite at extreme values.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"
#include "tests/shading/BsdfKinds.h"
#include "tests/shading/LatticeEstimate.h"

#include "osgRayTrace/shading/Fresnel.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 directionOf(double cosine, double phi)
{
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return Vec3(sine * std::cos(phi), sine * std::sin(phi), cosine);
}

/// Returns the share of a photon's flux that is scattered.
Estimate albedo(const Bsdf& bsdf, Vec3 wo, int samples, uint32_t seed)
{
    const auto weight = [&](float uLobe, float u, float v)
    {
        const std::optional<BsdfSample> sample =
            sampleBsdf(bsdf, wo, uLobe, u, v, Transport::Importance);
        return sample ? double(sample->weight.y) : 0.0;
    };
    return latticeEstimate(samples, seed, weight);
}

Bsdf perfectMetal(float alpha)
{
    Bsdf bsdf;
    bsdf.reflectance = Vec3(1.0f);
    bsdf.grazing = 1.0f;
    bsdf.alpha = alpha;
    return bsdf;
}

Bsdf roughGlass(float eta, float alpha)
{
    Bsdf bsdf;
    bsdf.coat = 1.0f;
    bsdf.eta = eta;
    bsdf.coatAverage = fresnelDielectricAverage(eta);
    bsdf.transmission = Vec3(1.0f);
    bsdf.alpha = alpha;
    return bsdf;
}

} // namespace

TEST_CASE("bsdf: single-scattering GGX keeps what the white furnace table says",
          "[shading][statistics][stability 32]")
{
    // The value 1 - ln 2 at alpha = 1 is exact; the others are rounded to 3 or 4 digits.
    const struct
    {
        float alpha;
        double albedo, rounding;
    } table[] = {{1.0f, 1.0 - std::log(2.0), 0.0},
                 {0.5f, 0.688, 5e-4},
                 {0.3f, 0.878, 5e-4},
                 {0.1f, 0.988, 5e-4},
                 {0.01f, 0.9999, 5e-5}};
    for (const auto& row : table)
    {
        CAPTURE(row.alpha);
        CHECK(albedo(perfectMetal(row.alpha), Vec3(0, 0, 1), 96000, 1)
                  .agrees(row.albedo, row.rounding + 1e-6));
    }
}

TEST_CASE("bsdf: no surface makes energy, from any angle", "[shading][statistics][long]")
{
    std::vector<BsdfKind> kinds = allKinds();
    for (BsdfKind& kind : extremeKinds())
        kinds.push_back(kind);
    for (BsdfKind& kind : extremeSmoothKinds())
        kinds.push_back(kind);
    for (const BsdfKind& kind : kinds)
    {
        for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05, 0.01, 0.00175})
        {
            CAPTURE(kind.name, cosine);
            const Estimate share = albedo(kind.bsdf, directionOf(cosine, 0.4), 12800, 2);
            const double limit = kind.bsdf.isSmooth() ? 1.0002 : 1.001;
            CHECK(share.mean() < limit + 4.0 * share.standardError());
        }
    }
}

TEST_CASE("bsdf: a white base takes what its rough coat leaves, no more",
          "[shading][statistics][long]")
{
    // In a white furnace light is lost only where the table of the coat's reflectance is too high:
    // from inside, a little at the critical angle.
    for (const float roughness : {0.0317f, 0.1f, 0.37f, 0.5f, 0.93f, 1.0f})
    {
        for (const float ior : {1.02f, 1.5f, 2.4f})
        {
            for (const BsdfKind& kind : kindsOf(roughness, 0.001f, ior))
            {
                for (const double cosine : {1.0, 0.75, 0.3, 0.1, 0.02, 0.003})
                {
                    const Estimate share = albedo(kind.bsdf, directionOf(cosine, 0.4), 48000, 6);
                    const double spread = 4.0 * share.standardError();
                    CAPTURE(kind.name, ior, cosine, share.mean(), spread);
                    CHECK(share.mean() < 1.001 + spread);
                    CHECK(share.mean() > (kind.bsdf.eta > 1.0f ? 0.999 : 0.985) - spread);
                }
            }
        }
    }
}

TEST_CASE("bsdf: smooth surfaces and Lambert's keep all energy", "[shading][statistics]")
{
    for (const BsdfKind& kind : allKinds())
    {
        const bool lossless = kind.bsdf.isDiffuse() || kind.bsdf.isSmooth();
        if (!lossless) continue;
        for (const double cosine : {1.0, 0.5, 0.1})
        {
            CAPTURE(kind.name, cosine);
            const Estimate share = albedo(kind.bsdf, directionOf(cosine, 0.4), 32000, 3);
            // Under a smooth coat this holds on average over angles of the light, and exactly for
            // light from all sides. The quadrature of the coat's mean reflectance is good to 1e-4.
            CHECK(share.agrees(1.0, 2e-4));
        }
    }
}

// A density may be right where samples fall and yet leave out a part of f: then light is lost.
TEST_CASE("bsdf: samples carry the whole integral of f, also beyond the critical angle",
          "[shading][statistics]")
{
    int checked = 0;
    for (const BsdfKind& kind : roughKinds())
    {
        if (kind.bsdf.alpha < 0.15f || std::abs(kind.bsdf.eta - 1.0f) < 0.1f) continue;
        for (const double cosine : {0.9, 0.6, 0.45, 0.2})
        {
            CAPTURE(kind.name, cosine);
            const Vec3 wo = directionOf(cosine, 0.4);
            const Estimate samples = albedo(kind.bsdf, wo, 40000, 11);
            Estimate integral; // over uniform directions
            Uniform random(12);
            for (int i = 0; i < 200000; ++i)
            {
                const Vec3 wi =
                    directionOf(random.between(-1.0, 1.0), random.between(0.0, 2 * M_PI));
                integral.add(4.0 * M_PI *
                             evalBsdf(kind.bsdf, wo, wi, Transport::Importance).fCos.y);
            }
            const double spread = std::hypot(samples.standardError(), integral.standardError());
            CHECK(integral.standardError() < 0.03);
            CHECK(std::abs(samples.mean() - integral.mean()) <= 4.0 * spread);
            ++checked;
        }
    }
    CHECK(checked >= 40); // at 4 standard errors: a false alarm of all has a probability of 0.004
}

TEST_CASE("bsdf: reflection is the same both ways", "[shading]")
{
    Uniform random(4);
    std::vector<BsdfKind> kinds = roughKinds();
    for (BsdfKind& kind : extremeKinds())
        kinds.push_back(kind);
    for (const BsdfKind& kind : kinds)
    {
        CAPTURE(kind.name);
        for (int i = 0; i < 3000; ++i)
        {
            // Every third pair is near the mirror direction, where a narrow lobe is, and every
            // third is at grazing angles.
            const double lowest = i % 3 == 2 ? 0.0 : 0.01, highest = i % 3 == 2 ? 0.02 : 1.0;
            const double cosine = random.between(lowest, highest), phi = random.between(0.0, 6.28);
            const Vec3 a = directionOf(cosine, phi);
            const double narrow = 3.0 * kind.bsdf.alpha;
            const Vec3 b =
                i % 3 == 1
                    ? directionOf(std::clamp(cosine + random.between(-narrow, narrow), 1e-3, 1.0),
                                  phi + M_PI + random.between(-narrow, narrow))
                    : directionOf(random.between(lowest, highest), random.between(0.0, 6.28));
            const Vec3 ab = evalBsdf(kind.bsdf, a, b).fCos / b.z;
            const Vec3 ba = evalBsdf(kind.bsdf, b, a).fCos / a.z;
            REQUIRE(glm::length(ab - ba) <= 2e-3f * glm::length(ab) + 1e-5f);
        }
    }
}

TEST_CASE("bsdf: refraction of radiance is the adjoint of that of importance", "[shading]")
{
    // f(wo -> wi) of radiance with eta equals f(wi -> wo) of importance with 1/eta, seen from the
    // other side.
    Uniform random(5);
    const auto turned = [](Vec3 w) { return Vec3(w.x, w.y, -w.z); };
    for (const float eta : {1.5f, 1.0f / 1.5f, 2.4f, 1.05f, 3.0f, 1.0f / 3.0f})
    {
        for (const float alpha : {0.01f, 0.05f, 0.3f, 1.0f})
        {
            const Bsdf near = roughGlass(eta, alpha), far = roughGlass(1.0f / eta, alpha);
            int compared = 0;
            for (int i = 0; i < 20000; ++i)
            {
                const Vec3 wo = directionOf(random.between(0.02, 1.0), random.between(0.0, 6.28));
                const float u = random(), v = random();
                const std::optional<BsdfSample> sample =
                    sampleBsdf(near, wo, kOneMinusEpsilon, u, v);
                if (!sample || !sample->transmitted || sample->wi.z > -0.02f) continue;
                const Vec3 wi = sample->wi;
                // Microfacets that are nearly edge-on are near total reflection from the other
                // side, where 1 - F depends on the last bits of the cosine.
                const Vec3d h = glm::normalize(Vec3d(wo) + Vec3d(wi) * double(eta));
                if (std::abs(glm::dot(Vec3d(wo), h)) < 0.01 ||
                    std::abs(glm::dot(Vec3d(wi), h)) < 0.01)
                    continue;
                const float radiance = evalBsdf(near, wo, wi).fCos.x / -wi.z;
                const float importance =
                    evalBsdf(far, turned(wi), turned(wo), Transport::Importance).fCos.x / wo.z;
                CAPTURE(eta, alpha, wo.z, wi.z);
                REQUIRE(importance == Approx(radiance).epsilon(2e-2));
                ++compared;
            }
            CHECK(compared > 100);
        }
    }
}

TEST_CASE("bsdf: radiance that enters glass is 1/eta^2 of the importance", "[shading]")
{
    for (const float alpha : {0.0f, 0.2f})
    {
        const Bsdf bsdf = roughGlass(1.5f, alpha);
        const Vec3 wo = directionOf(0.7, 0.0);
        const auto radiance = sampleBsdf(bsdf, wo, 0.9f, 0.2f, 0.3f, Transport::Radiance);
        const auto importance = sampleBsdf(bsdf, wo, 0.9f, 0.2f, 0.3f, Transport::Importance);
        REQUIRE((radiance && importance && radiance->transmitted));
        CHECK(radiance->weight.x * 2.25f == Approx(importance->weight.x));
        CHECK(radiance->pdfW == importance->pdfW);
    }
}

TEST_CASE("bsdf: grazing and extreme arguments give finite, consistent samples",
          "[shading][stability 35]")
{
    const float edges[] = {0.0f, 1e-7f, 0.25f, 0.5f, 0.999999f, kOneMinusEpsilon};
    const auto isGood = [](const BsdfSample& s)
    {
        return isFinite(s.weight) && s.weight.x >= 0.0f && s.weight.y >= 0.0f &&
               s.weight.z >= 0.0f && std::isfinite(s.pdfW) && s.pdfW > 0.0f &&
               std::abs(glm::length(s.wi) - 1.0f) < 1e-5f && (s.wi.z < 0.0f) == s.transmitted;
    };
    std::vector<BsdfKind> kinds = allKinds();
    for (const std::vector<BsdfKind>& extremes : {extremeKinds(), extremeSmoothKinds()})
        kinds.insert(kinds.end(), extremes.begin(), extremes.end());
    for (const BsdfKind& kind : kinds)
    {
        for (const double cosine : {1.0, 1e-2, 1e-3, 1e-4, 1e-6, 1e-10, 1e-30})
        {
            const Vec3 wo = directionOf(cosine, 2.0);
            int bad = 0;
            for (int i = 0; i < 6 * 6 * 6; ++i)
            {
                for (const Transport transport : {Transport::Radiance, Transport::Importance})
                {
                    const auto s = sampleBsdf(kind.bsdf, wo, edges[i / 36], edges[i / 6 % 6],
                                              edges[i % 6], transport);
                    if (s) bad += !isGood(*s);
                }
            }
            for (const double other : {1.0, 1e-3, 1e-10, 1e-30, 0.0, -1e-30, -1e-10, -1e-3, -1.0})
            {
                Vec3 wi = directionOf(std::abs(other), 2.5);
                if (other < 0.0) wi.z = -wi.z;
                const BsdfValue value = evalBsdf(kind.bsdf, wo, wi);
                bad += !(isFinite(value.fCos) && std::isfinite(value.pdfW) &&
                         value.fCos.x >= 0.0f && value.pdfW >= 0.0f);
            }
            CAPTURE(kind.name, cosine);
            CHECK(bad == 0);
        }
    }
}

TEST_CASE("bsdf: from below, and black, nothing is scattered", "[shading]")
{
    for (const BsdfKind& kind : allKinds())
    {
        CHECK_FALSE(sampleBsdf(kind.bsdf, Vec3(0, 0, -1), 0.5f, 0.5f, 0.5f));
        CHECK_FALSE(sampleBsdf(kind.bsdf, Vec3(1, 0, 0), 0.5f, 0.5f, 0.5f));
        CHECK(evalBsdf(kind.bsdf, Vec3(0, 0, -1), Vec3(0, 0, 1)).pdfW == 0.0f);
        CHECK(specularLobes(kind.bsdf, Vec3(0, 0, -1)).reflection == Vec3(0.0f));
    }
    CHECK_FALSE(sampleBsdf(Bsdf(), Vec3(0, 0, 1), 0.5f, 0.5f, 0.5f));
}

TEST_CASE("bsdf: an interface of index 1, or nearly 1, is invisible at any roughness",
          "[shading][stability 33]")
{
    for (const float ior : {1.0f, 1.0f + 1.2e-7f, 1.0f - 1.2e-7f, 1.00005f})
    {
        for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f})
        {
            for (const bool front : {true, false})
            {
                Scene scene;
                scene.materials = {glass(ior, roughness)};
                MaterialPoint point;
                point.front = front;
                const Bsdf bsdf = MaterialTable(scene).bsdf(0, point);
                for (const double cosine : {1.0, 0.5, 0.05, 1e-4})
                {
                    CAPTURE(ior, roughness, front, cosine);
                    const Vec3 wo = directionOf(cosine, 1.0);
                    const std::optional<BsdfSample> sample = sampleBsdf(bsdf, wo, 0.5f, 0.3f, 0.8f);
                    REQUIRE(sample);
                    CHECK(sample->transmitted);
                    CHECK(sample->delta);
                    CHECK(sample->pdfW == 1.0f);
                    CHECK(glm::length(sample->weight - Vec3(1.0f)) < 1e-6f);
                    CHECK(glm::length(sample->wi + wo) < 1e-6f);
                }
            }
        }
    }
}

TEST_CASE("bsdf: a clear slab passes (1-R)/(1+R)", "[shading]")
{
    // The transmittances include all internal bounces of two parallel smooth faces with n = 1.5.
    const struct
    {
        double degrees, transmittance;
    } cases[] = {{0.0, 0.92307692}, {60.0, 0.83623246}};
    for (const auto& c : cases)
    {
        const Vec3 wo = directionOf(std::cos(c.degrees * M_PI / 180.0), 0.0);
        const SpecularLobes in = specularLobes(roughGlass(1.5f, 0.0f), wo);
        const SpecularLobes out = specularLobes(roughGlass(1.0f / 1.5f, 0.0f), -in.refracted);
        const double through = double(in.refraction.x) * out.refraction.x, back = out.reflection.x;
        CAPTURE(c.degrees);
        CHECK(through / (1.0 - back * back) == Approx(c.transmittance).epsilon(1e-6));
        CHECK(in.reflection.x == Approx(back).epsilon(1e-5)); // R is the same from both sides
        CHECK(glm::length(out.refracted + wo) < 1e-6f);       // parallel to the incident ray
    }
}
