// PhotonLanesTest.cpp - sixteen look-ups at once find and reflect what sixteen single ones do.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"
#include "tests/photons/RandomAxis.h"
#include "tests/shading/BsdfKinds.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"
#include "osgRayTrace/integrators/shared/PixelProjection.h"

#include <algorithm>
#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 unit(Uniform& uniform)
{
    return turnedTo(Vec3(0, 0, uniform() < 0.5f ? 1 : -1),
                    squareToCosineHemisphere(uniform(), uniform()));
}

/// Returns photons in a unit cube on a lattice: sums are exact, whatever their order.
std::vector<Photon> cube(std::size_t count, uint32_t seed)
{
    Uniform uniform(seed);
    const auto coordinate = [&] { return std::floor((uniform() - 0.5f) * 1024.0f) * 0x1p-10f; };
    std::vector<Photon> photons(count);
    for (Photon& p : photons)
    {
        p.position = Vec3(coordinate(), coordinate(), coordinate());
        p.normal = p.wi = axis(uniform);
        p.power = Vec3(1.0f + std::floor(uniform() * 8.0f), 1.0f, 2.0f);
        p.edges = uniform() < 0.7f ? 2 : 9;
    }
    return photons;
}

void setLane(PhotonQueryLanes& queries, int i, const PhotonQuery& query)
{
    osgRayTrace::engine::setLane(queries.position, i, query.position);
    osgRayTrace::engine::setLane(queries.normal, i, query.normal);
    osgRayTrace::engine::setLane(queries.shadingNormal, i, query.shadingNormal);
    queries.radius[i] = query.radius;
}

/// Returns queries around a place that are as far apart and as unlike as round demands; unused
/// lanes hold NaN.
PhotonQueryLanes blockAround(Vec3 place, float radius, int round, Uniform& uniform)
{
    const float spreads[] = {0.0f, 0.5f, 2.0f, 6.0f, 40.0f};
    const float spread = spreads[round % 5] * radius;
    const float none = std::numeric_limits<float>::quiet_NaN();
    const auto offset = [&]
    { return std::floor((uniform() - 0.5f) * spread * 1024.0f) * 0x1p-10f; };
    const Vec3 normal = axis(uniform);
    PhotonQueryLanes queries;
    queries.mostEdges = round % 3 ? kMostEdges : 4;
    for (int i = 0; i < kLanes; ++i)
    {
        PhotonQuery query;
        query.position = place + Vec3(offset(), offset(), offset());
        query.normal = query.shadingNormal = round % 4 ? normal : axis(uniform);
        if (round % 7 == 0)
            query.shadingNormal = glm::normalize(query.normal + 0.4f * unit(uniform));
        query.radius = radius * (round % 2 ? 1.0f : 0.25f + 2.0f * uniform());
        const bool used = round % 6 || uniform() < 0.6f;
        if (!used) query.position = query.normal = Vec3(query.radius = none);
        if (used) queries.lanes |= 1u << i;
        setLane(queries, i, query);
    }
    if (round % 13 == 0) queries.radius[3] = -1.0f;
    if (round % 17 == 0) queries.radius[0] = none;
    return queries;
}

std::vector<std::vector<uint32_t>> byLane(const std::vector<FoundPhoton>& found)
{
    std::vector<std::vector<uint32_t>> lanes(kLanes);
    for (const FoundPhoton& f : found)
        for (LaneMask left = f.lanes; left; left &= left - 1)
            lanes[static_cast<std::size_t>(__builtin_ctz(left))].push_back(f.photon);
    return lanes;
}

} // namespace

TEST_CASE("photon lanes: sixteen look-ups are as many single ones", "[photons]")
{
    const Workers workers(2);
    uint64_t all = 0;
    // The maps have few photons around a query, more than are read together, and a dense cell.
    for (const auto& [count, cell] :
         {std::pair(3000, 0.2f), std::pair(60000, 0.1f), std::pair(9000, 4.0f)})
    {
        const std::vector<Photon> photons = cube(static_cast<std::size_t>(count), 5);
        const PhotonMap map(photons, cell, workers);
        Uniform uniform(11);
        for (int round = 0; round < 1500; ++round)
        {
            const float radii[] = {0.02f, 0.1f, 0.25f};
            const Vec3 place = photons[static_cast<std::size_t>(round)].position;
            const PhotonQueryLanes queries = blockAround(place, radii[round % 3], round, uniform);
            PhotonSumLanes sums;
            map.gather(queries, sums);
            std::vector<FoundPhoton> found;
            map.find(queries, found);
            const std::vector<std::vector<uint32_t>> lanes = byLane(found);
            for (int i = 0; i < kLanes; ++i)
            {
                CAPTURE(count, round, i);
                std::vector<uint32_t> own = lanes[static_cast<std::size_t>(i)], expectedOwn;
                if (!((queries.lanes >> i) & 1u))
                {
                    REQUIRE(sums.count[i] == 0);
                    REQUIRE(own.empty());
                    continue;
                }
                const PhotonQuery query = laneOf(queries, i);
                const PhotonSum expected = map.gather(query);
                REQUIRE(sums.count[i] == expected.count);
                all += expected.count;
                const Vec3 power = expected.count ? laneOf(sums.power, i) : Vec3(0.0f);
                if (round % 7)
                    REQUIRE(power == expected.power);
                else
                    REQUIRE(glm::distance(power, expected.power) <=
                            1e-5f * (1.0f + expected.power.x));
                map.find(query, expectedOwn);
                std::sort(own.begin(), own.end());
                std::sort(expectedOwn.begin(), expectedOwn.end());
                REQUIRE(own == expectedOwn);
            }
        }
    }
    CHECK(all > 250000);
}

TEST_CASE("photon lanes: look-ups in a window of the image miss no photon there", "[photons]")
{
    const Workers workers(2);
    const View views[] = {
        perspectiveView({0.1, 0.2, 3}, {0, 0.1, 0}, {0, 1, 0}, 30.0, 64, 64),
        patchView({0.1, -0.1, 0}, {0, 0, 1}, 1.2, 64),
    };
    std::size_t inside = 0, all = 0;
    for (const auto& [count, cell] :
         {std::pair(3000, 0.2f), std::pair(60000, 0.1f), std::pair(9000, 4.0f)})
    {
        const std::vector<Photon> photons = cube(static_cast<std::size_t>(count), 6);
        const PhotonMap map(photons, cell, workers);
        Uniform uniform(12);
        for (int round = 0; round < 600; ++round)
        {
            const std::optional<CameraRays> camera = cameraRays(views[round % 2], Vec3d(0.0));
            REQUIRE(camera);
            const PixelProjection projection(*camera);
            const Vec3 place = photons[static_cast<std::size_t>(round)].position;
            PhotonQueryLanes queries = blockAround(place, 0.1f, round, uniform);
            for (int i = 0; i < kLanes; ++i) // footprints have positive radii
                if (!(queries.radius[i] > 0.0f)) queries.lanes &= ~(1u << i);
            PixelLanes pixels;
            for (int i = 0; i < kLanes; ++i)
            {
                const PixelProjection::Place at = projection.place(place);
                pixels.x[i] = std::floor(at.x) + static_cast<float>(i % 4);
                pixels.y[i] = std::floor(at.y) + static_cast<float>(i / 4);
            }
            const ImageWindow window = projection.windowOf(pixels, kAllLanes);
            const auto isInWindow = [&](const FoundPhoton& f)
            {
                const PixelProjection::Place at = projection.place(map.position(f.photon));
                return at.x >= window.left && at.x < window.right && at.y >= window.bottom &&
                       at.y < window.top;
            };
            std::vector<FoundPhoton> expected, found;
            map.find(queries, expected);
            map.find(queries, window, found);
            all += expected.size();
            const auto dropOthers = [&](std::vector<FoundPhoton>& list) {
                list.erase(std::remove_if(list.begin(), list.end(), std::not_fn(isInWindow)),
                           list.end());
            };
            dropOthers(expected);
            dropOthers(found);
            inside += found.size();
            std::vector<std::vector<uint32_t>> a = byLane(found), b = byLane(expected);
            for (int i = 0; i < kLanes; ++i)
            {
                CAPTURE(count, round, i);
                const auto lane = static_cast<std::size_t>(i);
                std::sort(a[lane].begin(), a[lane].end());
                std::sort(b[lane].begin(), b[lane].end());
                REQUIRE(a[lane] == b[lane]);
            }
        }
    }
    CHECK(inside > 1000);
    CHECK(inside < all / 2);
}

namespace
{

/// Returns light from all directions onto both sides of the square of side 2 around the origin.
std::vector<Photon> sheet(std::size_t count, uint32_t seed)
{
    Uniform uniform(seed);
    std::vector<Photon> photons(count);
    for (Photon& p : photons)
    {
        p.position = Vec3(2.0f * uniform() - 1.0f, 2.0f * uniform() - 1.0f, 0.0f);
        p.wi = unit(uniform);
        p.normal = Vec3(0, 0, p.wi.z > 0.0f ? 1 : -1);
        p.power = Vec3(uniform(), uniform(), uniform());
        p.direct = uniform() < 0.3f;
    }
    return photons;
}

/// Returns the sum as its definition gives it, by evalBsdf.
Vec3 expectedPower(const PhotonMap& map, const GatherLanes& points, int i, uint32_t& count)
{
    const ShadingFrame frame(laneOf(points.queries.shadingNormal, i));
    const Vec3 wo = frame.toLocal(laneOf(points.wo, i));
    const Bsdf& bsdf = points.bsdfs[i];
    Vec3d power(0.0);
    for (const bool behind : {false, true})
    {
        if (behind && (!bsdf.transmits() || bsdf.isSmooth())) continue;
        PhotonQuery query = laneOf(points.queries, i);
        if (behind) query.normal = -query.normal;
        std::vector<uint32_t> found;
        map.find(query, found);
        count += static_cast<uint32_t>(found.size());
        for (const uint32_t k : found)
        {
            const Photon photon = map.photon(k);
            const Vec3 wi = frame.toLocal(photon.wi);
            if ((wi.z > 0.0f) == behind) continue;
            if (((points.directOnly >> i) & 1u) && !photon.direct) continue;
            power += Vec3d(evalBsdf(bsdf, wo, wi).fCos * photon.power /
                           glm::dot(photon.wi, query.normal));
        }
    }
    return Vec3(power);
}

} // namespace

TEST_CASE("photon lanes: surfaces of all kinds send back what their BSDFs say", "[photons]")
{
    const Workers workers(1);
    // One map has so few photons that lanes read them together, the other so many that each lane
    // reads its own.
    const PhotonMap few(sheet(800, 3), 0.4f, workers), many(sheet(6000, 3), 0.4f, workers);
    std::vector<BsdfKind> kinds = allKinds();
    for (BsdfKind& kind : extremeKinds())
        kinds.push_back(kind);
    Uniform uniform(29);
    const auto any = [&](std::size_t size)
    { return std::min(size - 1, static_cast<std::size_t>(uniform() * static_cast<float>(size))); };
    int lit = 0, dark = 0;
    GatherScratch scratch; // one for all, as a tile has
    for (int round = 0; round < 2000; ++round)
    {
        CAPTURE(round);
        const PhotonMap& map = round % 3 ? few : many;
        Bsdf bsdfs[kLanes];
        GatherLanes points;
        points.bsdfs = bsdfs;
        points.directOnly = round % 7 ? 0u : 0x5555u;
        const std::size_t kind = any(kinds.size());
        const Vec3 place(uniform() - 0.5f, uniform() - 0.5f, 0.0f);
        for (int i = 0; i < kLanes; ++i)
        {
            // The block has one kind of BSDF, or many side by side.
            bsdfs[i] = kinds[round % 2 ? kind : any(kinds.size())].bsdf;
            PhotonQuery query;
            query.position = place + Vec3(0.2f * uniform(), 0.2f * uniform(), 0.0f);
            query.normal = Vec3(0, 0, 1);
            query.shadingNormal =
                round % 4 ? query.normal : glm::normalize(query.normal + 0.4f * unit(uniform));
            query.radius = 0.2f;
            setLane(points.queries, i, query);
            Vec3 wo = turnedTo(query.normal, squareToCosineHemisphere(uniform(), uniform()));
            if (i == 5)
                wo = glm::normalize(Vec3(1, 0, 0.002f)); // often below the shading normal's horizon
            osgRayTrace::engine::setLane(points.wo, i, wo);
        }
        points.queries.lanes = round % 5 ? kAllLanes : 0x37f1u;
        PhotonSumLanes sums = {};
        gatherBsdf(map, points, sums, scratch);
        for (int i = 0; i < kLanes; ++i)
        {
            CAPTURE(i, bsdfs[i].alpha, bsdfs[i].eta, bsdfs[i].coat);
            if (!((points.queries.lanes >> i) & 1u))
            {
                REQUIRE(sums.count[i] == 0);
                continue;
            }
            uint32_t count = 0;
            const Vec3 expected = expectedPower(map, points, i, count),
                       power = laneOf(sums.power, i);
            REQUIRE(sums.count[i] == count);
            // For narrow lobes the angle between a microfacet and the lobe's axis loses digits.
            const float tolerance = bsdfs[i].alpha < 0.01f ? 2e-3f : 5e-5f;
            REQUIRE(glm::distance(power, expected) <= tolerance * glm::length(expected) + 1e-6f);
            lit += glm::length(expected) > 0.01f;
            dark += expected == Vec3(0.0f);
        }
    }
    CHECK(lit > 15000);
    CHECK(dark > 100);
}

TEST_CASE("photon lanes: what lanes out of use hold gets into nothing", "[photons]")
{
    // The albedo of lanes that are not Lambert's is not set, although their sums are added to.
    const PhotonMap map(sheet(800, 3), 0.4f, Workers(1));
    const float none = std::numeric_limits<float>::quiet_NaN();
    PhotonQueryLanes queries;
    Vec3Lanes albedo;
    for (int i = 0; i < kLanes; ++i)
    {
        PhotonQuery query;
        query.normal = query.shadingNormal = Vec3(0, 0, 1);
        query.radius = 0.2f;
        setLane(queries, i, query);
        osgRayTrace::engine::setLane(albedo, i, Vec3(i % 2 ? 0.5f : none));
    }
    queries.lanes = 0xaaaau;
    PhotonSumLanes sums;
    gatherDiffuse(map, queries, albedo, sums);
    const PhotonSum all = map.gather(laneOf(queries, 1));
    REQUIRE(all.count > 5);
    for (int i = 0; i < kLanes; ++i)
    {
        CHECK(sums.count[i] == (i % 2 ? all.count : 0));
        const Vec3 expected = i % 2 ? all.power * (0.5f * kInvPi) : Vec3(0.0f);
        CHECK(glm::distance(laneOf(sums.power, i), expected) <= 1e-5f);
    }
}
