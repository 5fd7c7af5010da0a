// BsdfLanesTest.cpp - sixteen surfaces at once give what each of them gives alone.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/shading/BsdfKinds.h"

#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/BsdfLanes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("bsdf lanes: values and densities are those of each surface alone", "[shading]")
{
    std::vector<BsdfKind> kinds;
    for (const std::vector<BsdfKind>& some : {allKinds(), extremeKinds()})
        for (const BsdfKind& kind : some)
            if (!kind.bsdf.transmits()) kinds.push_back(kind);
    int inside = 0; // bases below rough coats, whose rows have total reflection
    for (BsdfKind kind : roughKinds())
        if (kind.bsdf.coatRows && kind.bsdf.coatRows->critical > 0.0f)
        {
            kind.bsdf.transmission = Vec3(0.0f);
            kinds.push_back(kind);
            ++inside;
        }
    REQUIRE(inside > 0);
    REQUIRE(kinds.size() > 20);
    Uniform uniform(41);
    const auto any = [&]
    { return std::min(kinds.size() - 1, std::size_t(uniform() * float(kinds.size()))); };
    const auto direction = [&](Vec3 axis, float narrow)
    { return turnedTo(axis, squareToCosineHemisphere(narrow * uniform(), uniform())); };
    int lit = 0;
    for (int round = 0; round < 4000; ++round)
    {
        const std::size_t one = any();
        const LaneMask lanes = round % 3 ? kAllLanes : 0x8421u;
        Bsdf bsdfs[kLanes];
        std::string names[kLanes];
        Vec3Lanes normal, wo, wi;
        for (int i = 0; i < kLanes; ++i)
        {
            const BsdfKind& kind = kinds[round % 2 ? one : any()];
            bsdfs[i] = kind.bsdf;
            names[i] = kind.name;
            const Vec3 n = direction(Vec3(0, 0, uniform() < 0.5f ? 1 : -1), 1.0f);
            const Vec3 o = direction(uniform() < 0.05f ? -n : n, 1.0f);
            // Half of the directions are near the mirror direction, where narrow lobes are.
            const Vec3 mirrored = glm::normalize(n * (2.0f * glm::dot(n, o)) - o);
            setLane(normal, i, n);
            setLane(wo, i, o);
            setLane(wi, i, uniform() < 0.5f ? direction(mirrored, 0.01f) : direction(n, 1.0f));
        }
        Vec3Lanes fCos;
        FloatLanes pdfW;
        evalBsdfLanes(bsdfLanes(bsdfs, lanes), normal, wo, wi, lanes, fCos, pdfW);
        for (int i = 0; i < kLanes; ++i)
        {
            CAPTURE(round, i, names[i]);
            if (!((lanes >> i) & 1u))
            {
                REQUIRE(laneOf(fCos, i) == Vec3(0.0f));
                REQUIRE(pdfW[i] == 0.0f);
                continue;
            }
            const Vec3 n = laneOf(normal, i);
            Vec3 tangent, bitangent;
            frameOf(n.x, n.y, n.z, tangent, bitangent);
            const auto local = [&](Vec3 w)
            { return Vec3(glm::dot(w, tangent), glm::dot(w, bitangent), glm::dot(w, n)); };
            BsdfValue expected;
            if (local(laneOf(wi, i)).z > 0.0f)
                expected = evalBsdf(bsdfs[i], local(laneOf(wo, i)), local(laneOf(wi, i)));
            // A facet's distance from a narrow lobe's axis has no more digits than directions have.
            const float digits = 3e-5f + 1e-6f / std::max(bsdfs[i].alpha, kSmoothAlpha);
            REQUIRE(glm::distance(laneOf(fCos, i), expected.fCos) <=
                    digits * glm::length(expected.fCos) + 1e-7f);
            REQUIRE(std::fabs(pdfW[i] - expected.pdfW) <= digits * expected.pdfW + 1e-7f);
            lit += expected.pdfW > 0.0f;
        }
    }
    CHECK(lit > 30000);
}

TEST_CASE("bsdf lanes: next to the horizon there are numbers, for all kinds", "[shading]")
{
    std::vector<BsdfKind> kinds = allKinds();
    for (const std::vector<BsdfKind>& extremes : {extremeKinds(), extremeSmoothKinds()})
        kinds.insert(kinds.end(), extremes.begin(), extremes.end());
    const double cosines[] = {1.0, 1e-2, 1e-4, 1e-6, 1e-10, 1e-17, 1e-19, 1e-21, 1e-30};
    const auto directionOf = [](double cosine, double turn)
    {
        const double sine = std::sqrt(1.0 - cosine * cosine);
        return Vec3(sine * std::cos(turn), sine * std::sin(turn), cosine);
    };
    for (const BsdfKind& kind : kinds)
    {
        for (const double cosine : cosines)
        {
            Bsdf bsdfs[kLanes];
            Vec3Lanes normal, wo, wi, fCos;
            FloatLanes pdfW;
            for (int i = 0; i < kLanes; ++i)
            {
                bsdfs[i] = kind.bsdf;
                setLane(normal, i, Vec3(0, 0, 1));
                setLane(wo, i, directionOf(cosine, 2.0));
                Vec3 towards = directionOf(cosines[i % 9], i < 9 ? 2.5 : 2.0 + M_PI);
                if (i == 15) towards.z = -towards.z;
                setLane(wi, i, towards);
            }
            evalBsdfLanes(bsdfLanes(bsdfs, kAllLanes), normal, wo, wi, kAllLanes, fCos, pdfW);
            int bad = 0;
            for (int i = 0; i < kLanes; ++i)
                bad += !(isFinite(laneOf(fCos, i)) && std::isfinite(pdfW[i]) && fCos.x[i] >= 0.0f &&
                         pdfW[i] >= 0.0f);
            CAPTURE(kind.name, cosine);
            CHECK(bad == 0);
        }
    }
}
