// PhotonRadiusTest.cpp - the radius that a lookup begins with. Layer: test.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/integrators/PhotonGather.h"

#include <algorithm>
#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kSpacing = 0.01f;

/// A floor that is lit where x > 0: photons on a lattice.
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

/// Anywhere in a cube, looking anywhere; count of them, all but a few in one corner of it.
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

/// The definition, by a look-up for each radius.
float radiusByLookups(const PhotonMap& map, PhotonQuery query, float least, float largest)
{
    const auto enough = [&](float radius)
    {
        query.radius = radius;
        return map.gather(query).count >= kRadiusPhotons;
    };
    if (enough(least)) return least;
    float low = least, high = std::min(2.0f * least, largest);
    while (high < largest && !enough(high))
    {
        low = high;
        high = std::min(2.0f * high, largest);
    }
    for (int i = 0; i < 4; ++i)
    {
        const float middle = std::sqrt(low * high);
        (enough(middle) ? high : low) = middle;
    }
    return high;
}

} // namespace

TEST_CASE("photon radius: the same as by a look-up for each", "[photons]")
{
    const std::vector<Photon> photons = cloud(100000);
    const PhotonMap map(photons, 0.05f, Workers(1));
    int atLeast = 0, between = 0, atLargest = 0, many = 0;
    for (std::size_t k = 0; k < 2000; ++k)
    {
        PhotonQuery query = queryAt(0.0f);
        query.position = photons[k].position;
        query.normal = query.shadingNormal = photons[k].normal;
        query.mostEdges = k % 3 ? kMostEdges : 4;
        const float least = k % 5 ? 0.001f : 0.02f, largest = k % 7 ? 0.05f : 0.3f;
        const float radius = radiusOf(map, query, least, largest);
        REQUIRE(radius == radiusByLookups(map, query, least, largest));
        atLeast += radius == least;
        atLargest += radius == largest;
        between += radius > least && radius < largest;
        query.radius = largest;
        many += map.gather(query).count > 4096;
    }
    CAPTURE(atLeast, between, atLargest, many);
    CHECK(atLeast > 50);
    CHECK(between > 500);
    CHECK(atLargest > 50);
    CHECK(many > 50);
}

TEST_CASE("photon radius: holds the photons asked for, and hardly more", "[photons]")
{
    const Workers workers(1);
    const PhotonMap map = halfLit(workers);
    for (const float x : {-0.3f, -0.11f, -0.02f, 0.0f, 0.013f, 0.05f, 0.5f})
    {
        CAPTURE(x);
        PhotonQuery query = queryAt(x);
        const float radius = radiusOf(map, query, 0.001f, 1.0f);
        query.radius = radius;
        CHECK(map.gather(query).count >= kRadiusPhotons);
        query.radius = radius / 1.05f;
        CHECK(map.gather(query).count < kRadiusPhotons);
    }
    CHECK(radiusOf(map, queryAt(0.5f), 0.3f, 1.0f) == 0.3f);
    CHECK(radiusOf(map, queryAt(-2.0f), 0.001f, 1.0f) == 1.0f);
    CHECK(radiusOf(PhotonMap(), queryAt(0.0f), 0.001f, 1.0f) == 1.0f);
}

TEST_CASE("photon radius: no ring around light that has shrunk", "[photons]")
{
    const Workers workers(1);
    const PhotonMap map = halfLit(workers);
    // The radius of a later pass, away from the light: what it gets never rises.
    for (const float shrink : {1.0f, 0.7f, 0.5f, 0.3f})
    {
        float last = kInfinity;
        for (float x = 0.0f; x > -0.5f; x -= 0.004f)
        {
            PhotonQuery query = queryAt(x);
            query.radius = shrink * radiusOf(map, query, 0.001f, 0.6f);
            const float got = map.gather(query).power.x / (kPi * query.radius * query.radius);
            CAPTURE(shrink, x, query.radius, got, last);
            // A fifth: photons are counted, and a few of them make what is left at a rim.
            CHECK(got <= last + 0.2f);
            last = std::min(last, got);
        }
    }
}
