// PhotonRadiusTest.cpp - the radius that a look-up begins with. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"

#include <algorithm>
#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kSpacing = 0.01f;

/// Returns a floor that is lit if x > 0, with photons on a lattice.
PhotonMap halfLit(const Workers& workers)
{
    std::vector<Photon> photons;
    for (int x = 0; x < 200; ++x)
        for (int y = -100; y < 100; ++y)
        {
            Photon photon;
            photon.position = Vec3((static_cast<float>(x) + 0.5f) * kSpacing,
                                   (static_cast<float>(y) + 0.5f) * kSpacing, 0.0f);
            photon.wi = photon.normal = Vec3(0.0f, 0.0f, 1.0f);
            photon.power = Vec3(kSpacing * kSpacing);
            photons.push_back(photon);
        }
    return PhotonMap(photons, 0.2f, workers);
}

PhotonQuery queryAt(float x)
{
    PhotonQuery query;
    query.position = Vec3(x, 0.0f, 0.0f);
    query.normal = query.shadingNormal = Vec3(0.0f, 0.0f, 1.0f);
    return query;
}

/// Returns count photons anywhere in a cube with any direction; all but a tenth are in the cube's
/// middle.
std::vector<Photon> cloud(int count)
{
    Uniform uniform(12);
    const auto anywhere = [&] { return Vec3(uniform(), uniform(), uniform()) - Vec3(0.5f); };
    std::vector<Photon> photons(static_cast<std::size_t>(count));
    for (Photon& photon : photons)
    {
        photon.position = anywhere() * (uniform() < 0.1f ? 1.0f : 0.2f);
        photon.normal = glm::normalize(anywhere());
        photon.wi = glm::normalize(anywhere());
        photon.power = Vec3(1.0f);
        photon.edges = uniform() < 0.5f ? 2 : 5;
    }
    return photons;
}

uint32_t countOf(const PhotonMap& map, PhotonQuery query, float radius)
{
    query.radius = radius;
    return map.gather(query).count;
}

} // namespace

TEST_CASE("photon radius: look-ups with it hold the photons asked for, and larger ones more",
          "[photons]")
{
    const std::vector<Photon> photons = cloud(100000);
    const PhotonMap map(photons, 0.05f, Workers(1));
    GatherScratch scratch;
    int atLeast = 0, between = 0, atLargest = 0, many = 0;
    for (std::size_t k = 0; k < 2000; ++k)
    {
        PhotonQuery query = queryAt(0.0f);
        query.position = photons[k].position;
        query.normal = query.shadingNormal = photons[k].normal;
        query.mostEdges = k % 3 ? kMostEdges : 4;
        const float least = k % 5 ? 0.001f : 0.02f, largest = k % 7 ? 0.05f : 0.3f;
        const float radius = radiusOf(map, query, least, largest, scratch);
        CAPTURE(k, radius);
        if (radius > least) REQUIRE(countOf(map, query, radius) <= kRadiusPhotons);
        if (radius < largest)
        {
            REQUIRE(countOf(map, query, 1.00001f * radius) > kRadiusPhotons);
            if (radius > least) REQUIRE(countOf(map, query, radius) == kRadiusPhotons);
        }
        atLeast += radius == least;
        atLargest += radius == largest;
        between += radius > least && radius < largest;
        many += countOf(map, query, largest) > 4096;
    }
    CAPTURE(atLeast, between, atLargest, many);
    CHECK(atLeast > 50);
    CHECK(between > 500);
    CHECK(atLargest > 50);
    CHECK(many > 50);
}

TEST_CASE("photon radius: where photons lie on a lattice, where there are many and none",
          "[photons]")
{
    const Workers workers(1);
    const PhotonMap map = halfLit(workers);
    GatherScratch scratch;
    for (const float x : {-0.3f, -0.11f, -0.02f, 0.0f, 0.013f, 0.05f, 0.5f})
    {
        CAPTURE(x);
        const PhotonQuery query = queryAt(x);
        const float radius = radiusOf(map, query, 0.001f, 1.0f, scratch);
        CHECK(countOf(map, query, radius) <= kRadiusPhotons); // several are equally far away
        CHECK(countOf(map, query, radius) >= kRadiusPhotons - 8);
        CHECK(countOf(map, query, 1.00001f * radius) > kRadiusPhotons);
    }
    CHECK(radiusOf(map, queryAt(0.5f), 0.3f, 1.0f, scratch) == 0.3f);
    CHECK(radiusOf(map, queryAt(-2.0f), 0.001f, 1.0f, scratch) == 1.0f);
    CHECK(radiusOf(PhotonMap(), queryAt(0.0f), 0.001f, 1.0f, scratch) == 1.0f);
}

TEST_CASE("photon radius: the photons that chose it are right in the mean",
          "[photons][statistics][long]")
{
    // Each of 40,000 discs has new random photons on an even floor. The bounds of the radius are
    // such that no disc meets them, that half of the discs meet one below, one above, or one of
    // both. In the last case, of 4,000 discs, there are so many photons that the radius is narrowed
    // down first.
    const struct
    {
        int photons;
        float least, largest; ///< in radii that hold 16 photons in the mean
    } cases[] = {{400, 0.01f, 4.0f},
                 {400, 1.0f, 4.0f},
                 {400, 0.01f, 1.0f},
                 {400, 0.9f, 1.1f},
                 {12000, 0.01f, 20.0f}};
    const Workers workers(1);
    GatherScratch scratch;
    for (const auto& c : cases)
    {
        Uniform uniform(5);
        const float usual =
            std::sqrt(16.0f / (kPi * static_cast<float>(c.photons))); // on a square of area 1
        const int discs = c.photons > 1000 ? 4000 : 40000;
        double sum = 0.0, squares = 0.0;
        for (int disc = 0; disc < discs; ++disc)
        {
            std::vector<Photon> photons(static_cast<std::size_t>(c.photons));
            for (Photon& photon : photons)
            {
                photon.position = Vec3(uniform() - 0.5f, uniform() - 0.5f, 0.0f);
                photon.wi = photon.normal = Vec3(0.0f, 0.0f, 1.0f);
                photon.power = Vec3(1.0f / static_cast<float>(c.photons));
            }
            const PhotonMap map(photons, 2.0f * usual, workers);
            PhotonQuery query = queryAt(0.0f);
            query.radius =
                radiusOf(map, query, c.least * usual, std::min(0.5f, c.largest * usual), scratch);
            const double density = map.gather(query).power.x / (kPi * query.radius * query.radius);
            sum += density;
            squares += density * density;
        }
        const double mean = sum / discs;
        const double error = std::sqrt((squares / discs - mean * mean) / discs);
        CAPTURE(c.photons, c.least, c.largest, mean, error);
        CHECK(std::abs(mean - 1.0) < 4.0 * error);
        CHECK(error <
              (c.photons > 1000 ? 0.005 : 0.0015)); // counting one photon more would add 1/16
    }
}

TEST_CASE("photon radius: no ring around light that has shrunk", "[photons]")
{
    const Workers workers(1);
    const PhotonMap map = halfLit(workers);
    GatherScratch scratch;
    // With the radius of a later pass, the density never rises on the way from the light.
    for (const float shrink : {1.0f, 0.7f, 0.5f, 0.3f})
    {
        float last = kInfinity;
        for (float x = 0.0f; x > -0.5f; x -= 0.004f)
        {
            PhotonQuery query = queryAt(x);
            query.radius = shrink * radiusOf(map, query, 0.001f, 0.6f, scratch);
            const float got = map.gather(query).power.x / (kPi * query.radius * query.radius);
            CAPTURE(shrink, x, query.radius, got, last);
            // The density may rise by a fifth, because photons are counted, and few of them are
            // left at a rim.
            CHECK(got <= last + 0.2f);
            last = std::min(last, got);
        }
    }
}
