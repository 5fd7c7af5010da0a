// PhotonMapTest.cpp - the grid finds what a search through all photons finds, whatever its cells.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/photons/RandomAxis.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonMapMemory.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns photons on a lattice of 2^-10 in a cube of side 1 around centre, with powers of 1 to 8:
/// all sums and squares are exact in float, so that the grid's sums must equal those of the search
/// through all photons.
std::vector<Photon> latticePhotons(std::size_t count, Vec3 centre, uint32_t seed)
{
    Uniform uniform(seed);
    const auto coordinate = [&] { return std::floor((uniform() - 0.5f) * 1024.0f) * 0x1p-10f; };
    std::vector<Photon> photons(count);
    for (Photon& p : photons)
    {
        p.position = centre + Vec3(coordinate(), coordinate(), coordinate());
        p.normal = axis(uniform);
        p.wi = axis(uniform);
        p.power = Vec3(1.0f + std::floor(uniform() * 8.0f), 1.0f, 2.0f);
        p.edges = 2 + static_cast<uint32_t>(&p - photons.data()) % 7;
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
    for (const Photon& p : photons)
    {
        const Vec3 d = p.position - q.position;
        const bool inside = glm::dot(d, d) <= q.radius * q.radius &&
                            std::fabs(glm::dot(d, q.normal)) <= farthestFromPlane(q);
        if (!inside || !(glm::dot(p.wi, q.normal) > 0.0f)) continue;
        if (glm::dot(p.normal, q.normal) < kLeastNormalCosine) continue;
        if (p.edges > q.mostEdges) continue;
        ++sum.count;
        sum.power += p.power;
    }
    return sum;
}

/// Returns whether two maps of as many photons hold the same ones in the same order.
bool samePhotons(const PhotonMap& one, const PhotonMap& two)
{
    bool same = true;
    for (uint32_t k = 0; k < one.size(); ++k)
    {
        const Photon a = one.photon(k), b = two.photon(k);
        same &= a.position == b.position && a.power == b.power && a.wi == b.wi &&
                a.normal == b.normal && a.edges == b.edges && a.bin == b.bin;
    }
    return same;
}

PhotonQuery query(Vec3 position, Vec3 normal, float radius)
{
    PhotonQuery q;
    q.position = position;
    q.normal = q.shadingNormal = normal;
    q.radius = radius;
    return q;
}

/// Returns how many photons the brute force found in all.
uint64_t checkAgainstBruteForce(const PhotonMap& map, const std::vector<Photon>& photons,
                                const std::vector<PhotonQuery>& queries)
{
    uint64_t found = 0;
    for (const PhotonQuery& q : queries)
    {
        const PhotonSum expected = bruteForce(photons, q), sum = map.gather(q);
        std::vector<uint32_t> indices;
        map.find(q, indices);
        CAPTURE(q.position.x, q.position.y, q.position.z, q.radius, photons.size());
        REQUIRE(sum.count == expected.count);
        REQUIRE(indices.size() == expected.count);
        REQUIRE(sum.power == expected.power);
        found += expected.count;
    }
    return found;
}

} // namespace

TEST_CASE("photon map: counts and powers are those of a search through all photons", "[photons]")
{
    const Workers workers(2);
    // The numbers of photons give 256 to 2^20 buckets. The cells go from a thousandth of the cube,
    // with colliding buckets, to one cell for all.
    for (const std::size_t count : {1u, 2u, 100u, 300u, 5000u, 70000u, 600000u, 1u << 20})
    {
        for (const Vec3 centre : {Vec3(0.0f), Vec3(-40.0f, 8.0f, 100.0f)})
        {
            const std::vector<Photon> photons =
                latticePhotons(count, centre, static_cast<uint32_t>(count));
            for (const float cell : {0.001f, 0.02f, 0.3f, 50.0f})
            {
                if (count > 100000 && cell != 0.02f) continue; // brute force takes its time
                const PhotonMap map(photons, cell, workers);
                Uniform uniform(7);
                std::vector<PhotonQuery> queries;
                const int number = count > 100000 ? 12 : 120;
                for (int k = 0; k < number; ++k)
                {
                    // The query is in the cube, beside it or far off.
                    const float spread = k % 3 == 0 ? 4.0f : 1.25f;
                    const auto lattice = [&]
                    { return std::floor((uniform() - 0.5f) * spread * 1024.0f) * 0x1p-10f; };
                    const float radii[] = {0.0f, 0x1p-10f, 0x1p-6f, 0x1p-4f, 0.25f, 2.0f};
                    queries.push_back(query(centre + Vec3(lattice(), lattice(), lattice()),
                                            axis(uniform), radii[k % 6]));
                    queries.back().position =
                        k % 4 ? queries.back().position
                              : photons[static_cast<std::size_t>(k) % count].position;
                    queries.back().mostEdges = k % 2 ? kMostEdges : 4;
                }
                CAPTURE(count, cell);
                const uint64_t found = checkAgainstBruteForce(map, photons, queries);
                if (count >= 300) CHECK(found > 0);
            }
        }
    }
}

TEST_CASE("photon map: slanted discs, up to the rounding of their rims", "[photons]")
{
    const Workers workers(1);
    std::vector<Photon> photons = latticePhotons(20000, Vec3(3.0f), 3);
    Uniform uniform(5);
    const auto direction = [&]
    {
        const Vec3 v(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f);
        return glm::normalize(v + Vec3(1e-3f));
    };
    for (Photon& p : photons)
        p.wi = p.normal = direction();
    for (const float cell : {0.01f, 0.1f, 1.0f})
    {
        const PhotonMap map(photons, cell, workers);
        uint64_t found = 0;
        for (int k = 0; k < 300; ++k)
        {
            PhotonQuery q = query(photons[static_cast<std::size_t>(k)].position, direction(),
                                  0.05f + 0.3f * uniform());
            uint32_t least = 0, most = 0;
            for (const Photon& p : photons)
            {
                const Vec3d d = Vec3d(p.position) - Vec3d(q.position), n(q.normal);
                // The largest excess over the limits; normals are stored in bytes.
                const double off = std::fabs(glm::dot(d, n)), cosine = glm::dot(Vec3d(p.normal), n);
                const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
                const double gap =
                    off - double(gapTolerance(q.position, q.radius)) - glm::length(d) * sine;
                const double excess = std::max(
                    {glm::length(d) / double(q.radius) - 1.0,
                     off / (double(kPlaneShare * q.radius)) - 1.0, -glm::dot(Vec3d(p.wi), n),
                     gap / double(q.radius) * 1e-4, (double(kLeastNormalCosine) - cosine) * 1e-4});
                least += excess < -2e-6;
                most += excess <= 2e-6;
            }
            const uint32_t count = map.gather(q).count;
            CAPTURE(cell, k);
            REQUIRE(count >= least);
            REQUIRE(count <= most);
            found += count;
        }
        CHECK(found > 1000);
    }
}

TEST_CASE("photon map: a radius below the spacing of floats finds what lies at the very point",
          "[photons]")
{
    const Workers workers(1);
    Uniform uniform(11);
    std::vector<Photon> photons(4000);
    for (std::size_t k = 0; k < photons.size(); ++k)
    {
        photons[k].position = Vec3(1000.0f + uniform(), -1000.0f - uniform(), 1000.0f + uniform());
        if (k % 4) photons[k].position = photons[k - 1].position; // four at each place
        photons[k].normal = photons[k].wi = Vec3(0, 0, 1);
        photons[k].power = Vec3(1.0f);
    }
    for (const float cell : {0.0f, 1e-7f, 1e-3f, 1.0f})
    {
        const PhotonMap map(photons, cell, workers);
        for (std::size_t k = 0; k < photons.size(); k += 7)
            for (const float radius : {0.0f, 1e-7f})
            {
                const PhotonQuery q = query(photons[k].position, Vec3(0, 0, 1), radius);
                const PhotonSum expected = bruteForce(photons, q);
                REQUIRE(expected.count >= 4);
                REQUIRE(map.gather(q).count == expected.count);
            }
    }
}

TEST_CASE("photon map: radii and places that are out of all bounds", "[photons]")
{
    const Workers workers(2);
    const float huge = std::numeric_limits<float>::infinity(), none = std::nanf("");
    const PhotonMap empty(std::vector<Photon>{}, 0.1f, workers);
    CHECK(empty.gather(query(Vec3(0.0f), Vec3(0, 0, 1), 1e30f)).count == 0);
    CHECK(empty.size() == 0);

    const std::vector<Photon> photons = latticePhotons(3000, Vec3(0.0f), 9);
    for (const float cell : {0.0f, 1e-30f, 0.05f, 1e30f, huge})
    {
        const PhotonMap map(photons, cell, workers);
        uint32_t all = 0;
        for (const Photon& p : photons)
            all += p.normal == Vec3(0, 0, 1) && p.wi == Vec3(0, 0, 1);
        CHECK(all > 0);
        CHECK(map.gather(query(Vec3(0.0f), Vec3(0, 0, 1), 1e30f)).count == all);
        CHECK(map.gather(query(Vec3(5.0f), Vec3(0, 0, 1), 1e18f)).count == all);
        CHECK(map.gather(query(Vec3(1e30f), Vec3(0, 0, 1), 1.0f)).count == 0);
        CHECK(map.gather(query(Vec3(none), Vec3(0, 0, 1), 1.0f)).count == 0);
        CHECK(map.gather(query(Vec3(0.0f), Vec3(0, 0, 1), none)).count == 0);
        CHECK(map.gather(query(Vec3(0.0f), Vec3(0, 0, 1), -1.0f)).count == 0);
    }
}

TEST_CASE("photon map: a million photons in one cell", "[photons]")
{
    const Workers workers(2);
    Photon photon;
    photon.position = Vec3(1, 2, 3);
    photon.normal = photon.wi = Vec3(0, 1, 0);
    photon.power = Vec3(1.0f, 0.5f, 0.25f);
    std::vector<Photon> photons(1000000, photon);
    photons.push_back(photon);
    photons.back().position = Vec3(100.0f);
    const PhotonMap map(photons, 0.01f, workers);
    const PhotonSum sum = map.gather(query(photon.position, photon.normal, 0.01f));
    CHECK(sum.count == 1000000);
    CHECK(sum.power == Vec3(1000000.0f, 500000.0f, 250000.0f)); // sums by lane stay exact
    CHECK(map.gather(query(Vec3(100.0f), photon.normal, 0.01f)).count == 1);
    CHECK(map.bytes() < 50u * photons.size());
}

TEST_CASE("photon map: the memory of another map makes no difference", "[photons]")
{
    const Workers workers(2);
    const std::vector<Photon> photons = latticePhotons(30000, Vec3(0.0f), 22);
    const PhotonMap alone(photons, 0.1f, workers, true);
    // The others have fewer and more photons, other cells, no bins, and dense cells.
    for (const std::size_t count : {0, 20000, 29900, 32000, 70000})
        for (const bool bins : {false, true})
        {
            CAPTURE(count, bins);
            const std::vector<Photon> others = latticePhotons(count, Vec3(3.0f), 23);
            PhotonMapMemory memory;
            memory.giveBack(PhotonMap(others, bins ? 0.1f : 1.5f, workers, bins));
            const std::size_t kept = memory.bytes();
            const PhotonMap map(photons, 0.1f, workers, true, memory.take());
            CHECK(memory.bytes() == 0);
            REQUIRE(map.size() == photons.size());
            CHECK(samePhotons(map, alone));
            // 32,000 photons leave room for 30,000, and all of it is used.
            if (count == 32000 && bins) CHECK(map.bytes() == kept);
        }
}

TEST_CASE("photon map: the same for any number of threads", "[photons]")
{
    const std::vector<Photon> photons = latticePhotons(100000, Vec3(0.0f), 21);
    const PhotonMap one(photons, 0.02f, Workers(1)), two(photons, 0.02f, Workers(2));
    REQUIRE(one.size() == photons.size());
    CHECK(samePhotons(one, two));
}
