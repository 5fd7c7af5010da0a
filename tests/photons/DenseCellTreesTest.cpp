// DenseCellTreesTest.cpp - look-ups in dense cells find the same photons, and read few of them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonMap.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

const Vec3 kUp(0, 0, 1);

/// Returns photons on floors above each other and on walls between them, on a lattice of 2^-20
/// within a cube of 2^-10, so that all distances and sums are exact. Most photons come from above,
/// the others from the side.
std::vector<Photon> denseCell(std::size_t count, uint32_t seed)
{
    Uniform uniform(seed);
    const auto coordinate = [&](float steps)
    { return std::floor((uniform() - 0.5f) * steps) * (0x1p-10f / steps); };
    std::vector<Photon> photons(count);
    for (Photon& p : photons)
    {
        const bool wall = uniform() < 0.2f;
        p.position = Vec3(coordinate(1024.0f), coordinate(1024.0f), coordinate(4.0f));
        if (wall) std::swap(p.position.x, p.position.z);
        p.normal = wall ? Vec3(1, 0, 0) : kUp;
        p.wi = uniform() < 0.99f ? p.normal : Vec3(0, 1, 0);
        p.power = Vec3(1.0f, 2.0f, 1.0f + std::floor(uniform() * 4.0f));
        p.edges = uniform() < 0.999f ? 2 : 9;
    }
    return photons;
}

/// Returns how far a photon may be from the disc's plane whose normal is the disc's.
float farthestFromPlane(const PhotonQuery& q)
{
    return std::min(kPlaneShare * q.radius, gapTolerance(q.position, q.radius));
}

PhotonSum bruteForce(const std::vector<Photon>& photons, const PhotonQuery& q)
{
    PhotonSum sum;
    Vec3d power(0.0);
    for (const Photon& p : photons)
    {
        const Vec3 d = p.position - q.position;
        if (!(glm::dot(d, d) <= q.radius * q.radius)) continue;
        if (!(std::fabs(glm::dot(d, q.normal)) <= farthestFromPlane(q))) continue;
        if (!(glm::dot(p.wi, q.normal) > 0.0f) || p.edges > q.mostEdges) continue;
        if (glm::dot(p.normal, q.normal) < kLeastNormalCosine) continue;
        ++sum.count;
        const double shading = glm::dot(p.wi, q.shadingNormal), cosine = glm::dot(p.wi, q.normal);
        power += Vec3d(p.power) * std::max(shading / cosine, 0.0);
    }
    sum.power = Vec3(power);
    return sum;
}

PhotonQuery query(Vec3 position, float radius)
{
    PhotonQuery q;
    q.position = position;
    q.normal = q.shadingNormal = kUp;
    q.radius = radius;
    return q;
}

} // namespace

TEST_CASE("dense cells: what a search through all photons finds, added up or read", "[photons]")
{
    const std::vector<Photon> photons = denseCell(60000, 4);
    const Workers workers(2);
    uint64_t addedUp = 0;
    for (const float cell : {1.0f, 0x1p-12f}) // one dense cell, and many side by side
    {
        const PhotonMap map(photons, cell, workers);
        Uniform uniform(8);
        for (int k = 0; k < 400; ++k)
        {
            const float radii[] = {0.0f, 0x1p-19f, 0x1p-15f, 0x1p-12f, 0x1p-11f, 0x1p-9f, 1.0f};
            PhotonQuery q = query(photons[static_cast<std::size_t>(k) * 97].position, radii[k % 7]);
            q.mostEdges = k % 3 ? kMostEdges : 4;
            const bool flat = k % 5 != 0;
            if (!flat) q.shadingNormal = glm::normalize(Vec3(0.25f, uniform() - 0.5f, 1.0f));
            if (k % 11 == 0) q.normal = q.shadingNormal = Vec3(1, 0, 0);
            const PhotonSum expected = bruteForce(photons, q), sum = map.gather(q);
            std::vector<uint32_t> found;
            map.find(q, found);
            CAPTURE(cell, k, q.radius);
            REQUIRE(sum.count == expected.count);
            REQUIRE(found.size() == expected.count);
            if (flat)
                REQUIRE(sum.power == expected.power);
            else
                REQUIRE(glm::distance(sum.power, expected.power) <= 1e-4f * expected.power.y);
            // If fewer photons were read than found, the others were added by the sums of their
            // boxes.
            if (map.work(q) < expected.count) addedUp += expected.count - map.work(q);
        }
    }
    CHECK(addedUp > 400000);
}

TEST_CASE("dense cells: small discs and whole ones read little", "[photons][stability 42]")
{
    constexpr std::size_t kPhotons = 1000000;
    Uniform uniform(3);
    std::vector<Photon> photons(kPhotons);
    for (Photon& p : photons)
    {
        p.position = Vec3(uniform() - 0.5f, uniform() - 0.5f, 0.0f) * 1e-3f;
        p.normal = p.wi = kUp;
        p.power = Vec3(1.0f);
    }
    photons[0].position = Vec3(1.0f); // otherwise cells would have the dense cell's size
    const PhotonMap map(photons, 0.01f, Workers(2));
    CHECK(map.bytes() < 50u * kPhotons);
    // The disc holds 26 photons: a uniform grid's cells of two radii hold 33, and the disc touches
    // four of them.
    const float radius = 1e-3f * std::sqrt(26.0f / (float(kPhotons) * kPi));
    std::size_t most = 0, found = 0;
    for (std::size_t k = 1; k < 4000; ++k)
    {
        const PhotonQuery q = query(photons[k].position, radius);
        most = std::max(most, map.work(q));
        found += map.gather(q).count;
    }
    CHECK(found > 4000u * 20u);
    CHECK(most <= 64u * 16u);
    for (const float large : {2e-4f, 5e-4f, 2e-3f, 1.0f, 1e30f})
    {
        CAPTURE(large);
        const PhotonQuery q = query(Vec3(0.0f), large);
        CHECK(map.gather(q).count >= 120000);
        CHECK(map.work(q) <= 60000); // the photons at the rim
    }
    CHECK(map.gather(query(Vec3(0.0f), 5e-3f)).count == kPhotons - 1);

    // All photons are in one point, and the disc is around it.
    for (std::size_t k = 1; k < kPhotons; ++k)
        photons[k].position = Vec3(0.0f);
    const PhotonMap point(photons, 0.01f, Workers(2));
    const PhotonQuery q = query(Vec3(0.0f), 1e-5f);
    CHECK(point.gather(q).count == kPhotons - 1);
    CHECK(point.gather(q).power == Vec3(float(kPhotons - 1)));
    CHECK(point.work(q) <= 64);
    CHECK(point.work(query(Vec3(1e-4f, 0.0f, 0.0f), 5e-5f)) == 0);
}

TEST_CASE("dense cells: the same for any number of threads", "[photons]")
{
    const std::vector<Photon> photons = denseCell(50000, 6);
    const PhotonMap one(photons, 0.01f, Workers(1)), two(photons, 0.01f, Workers(2));
    bool same = true;
    for (uint32_t k = 0; k < photons.size(); ++k)
        same &= one.photon(k).position == two.photon(k).position &&
                one.photon(k).power == two.photon(k).power;
    CHECK(same);
    for (const float radius : {0x1p-13f, 0x1p-11f, 1.0f})
    {
        const PhotonQuery q = query(photons[7].position, radius);
        CHECK(one.gather(q).power == two.gather(q).power);
        CHECK(one.work(q) == two.work(q));
    }
}
