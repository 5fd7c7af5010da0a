// BeamMapTest.cpp - look-ups of photon beams and points, and how fast their errors fall.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"

#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/photons/VolumePhotons.h"
#include "osgRayTrace/sampling/Warp.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kSigma = 0.1f; ///< extinction; nothing is absorbed
constexpr double kPiD = 3.14159265358979;

Vec3 randomDirection(Uniform& random)
{
    const float u = random(), v = random();
    return squareToCone(Vec2(u, v), 2.0f);
}

/// Returns rays whose stretches are [0, end).
BeamQuery queryOf(const RayBlock& rays, float end, float radius, float g = 0.0f)
{
    BeamQuery query;
    query.ray = &rays;
    query.lanes = kAllLanes;
    query.mostEdges = 99;
    query.radius = radius;
    for (int i = 0; i < kLanes; ++i)
    {
        query.begin[i] = 0.0f;
        query.end[i] = end;
        query.anisotropy[i] = g;
        query.medium[i] = kOutside;
        setLane(query.sigmaT, i, Vec3(kSigma));
        setLane(query.sigmaS, i, Vec3(kSigma));
    }
    return query;
}

std::vector<PhotonBeam> randomBeams(Uniform& random, int count)
{
    std::vector<PhotonBeam> beams;
    for (int k = 0; k < count; ++k)
    {
        PhotonBeam beam;
        beam.origin = Vec3(random(), random(), random()) * 4.0f - 2.0f;
        beam.direction = randomDirection(random);
        beam.length = 3.0f * random();
        beam.power = Vec3(random(), random(), random());
        beam.medium = k % 5 == 0 ? MediumId(1) : kOutside;
        beam.edges = static_cast<uint32_t>(k % 4);
        beams.push_back(beam);
    }
    return beams;
}

/// Returns what the beams scatter towards a ray, in double, beam by beam.
Vec3d expectedAlong(const std::vector<PhotonBeam>& beams, Vec3d origin, Vec3d d, double end,
                    double radius, float g, uint32_t mostEdges)
{
    Vec3d sum(0.0);
    for (const PhotonBeam& beam : beams)
    {
        if (beam.medium != kOutside || beam.edges > mostEdges) continue;
        const Vec3d b(beam.direction), w = Vec3d(beam.origin) - origin, n = glm::cross(d, b);
        const double sine2 = glm::dot(n, n), sine = std::sqrt(sine2);
        const double along = glm::dot(glm::cross(w, b), n) / sine2;
        const double onBeam = glm::dot(glm::cross(w, d), n) / sine2;
        if (std::abs(glm::dot(w, n)) > radius * sine) continue;
        if (along < 0.0 || along >= end || onBeam < 0.0 || onBeam >= double(beam.length)) continue;
        const double phase = double(evalPhase(g, -float(glm::dot(d, b))));
        sum += Vec3d(beam.power) * (double(kSigma) * phase / (2.0 * radius * sine) *
                                    std::exp(-double(kSigma) * (along + onBeam)));
    }
    return sum;
}

/// Returns rays at a distance from the origin, in random directions across the way to it.
RayBlock raysAround(Uniform& random, float distance, float before)
{
    RayBlock rays;
    for (int i = 0; i < kLanes; ++i)
    {
        const Vec3 foot = randomDirection(random);
        const Vec3 across = glm::normalize(glm::cross(foot, randomDirection(random)));
        setRay(rays, i, plainOf(foot * distance - across * before), plainOf(across), 0.0f, 1e30f);
    }
    return rays;
}

/// Holds squares of relative errors by number of passes.
constexpr int kCounts[] = {64, 128, 256, 512, 1024, 2048, 4096};
struct Squares
{
    double squares[7] = {};
    Estimate last; ///< values over truth after all passes

    double slope() const
    {
        const std::vector<double> counts(std::begin(kCounts), std::end(kCounts));
        return logLogSlope(counts, std::vector<double>(std::begin(squares), std::end(squares)));
    }
    void add(int at, double ratio)
    {
        squares[at] += (ratio - 1.0) * (ratio - 1.0);
        if (at == 6) last.add(ratio);
    }
};

} // namespace

TEST_CASE("beams: look-ups find what all beams hold", "[photons][media]")
{
    Uniform random(3);
    const std::vector<PhotonBeam> beams = randomBeams(random, 700);
    const BeamMap map(beams, 0.4f);
    REQUIRE(map.size() == beams.size());
    for (const float spread : {0.0f, 0.1f, 3.0f}) // one ray, a bundle, all directions
        for (int k = 0; k < 40; ++k)
        {
            const float radius = k % 2 ? 0.2f : 0.03f, g = k % 3 ? 0.4f : -0.7f;
            RayBlock rays;
            const Vec3 eye = Vec3(random(), random(), random()) * 4.0f - 2.0f;
            const Vec3 axis = randomDirection(random);
            for (int i = 0; i < kLanes; ++i)
            {
                const Vec3 d = glm::normalize(axis + randomDirection(random) * spread * 0.5f);
                const Vec3 from = eye + randomDirection(random) * spread * 0.1f;
                setRay(rays, i, plainOf(from), plainOf(d), 0.0f, 1e30f);
            }
            BeamQuery query = queryOf(rays, 2.5f, radius, g);
            query.mostEdges = 2;
            const RayBlock* block = &rays;
            const LaneMask lanes = kAllLanes;
            BeamPieces found;
            const RayBundle bundle = bundleOf(&block, &lanes, 1);
            map.find(bundle, radius, found);
            Vec3Lanes radiance;
            gatherBeams(found, bundle, query, radiance);
            for (int i = 0; i < kLanes; ++i)
            {
                const Vec3d origin(rays.originX[i], rays.originY[i], rays.originZ[i]);
                const Vec3d d(rays.directionX[i], rays.directionY[i], rays.directionZ[i]);
                const Vec3d expected = expectedAlong(beams, origin, d, 2.5, double(radius), g, 2);
                for (int c = 0; c < 3; ++c)
                {
                    CAPTURE(spread, k, i, c);
                    CHECK(double(laneOf(radiance, i)[c]) ==
                          Approx(expected[c]).epsilon(2e-4).margin(1e-7));
                }
            }
        }
}

TEST_CASE("beams: light of droplets is spread by their phase function", "[photons][media]")
{
    Uniform random(11);
    const Phase droplets = dropletPhase(15.0f);
    const BeamMap map(randomBeams(random, 200), 0.4f);
    RayBlock rays;
    for (int i = 0; i < kLanes; ++i)
        setRay(rays, i, plainOf(Vec3(random(), random(), -3.0f)),
               plainOf(glm::normalize(Vec3(random() - 0.5f, random() - 0.5f, 1.0f))), 0.0f, 1e30f);
    const RayBlock* block = &rays;
    const LaneMask lanes = kAllLanes;
    BeamPieces found;
    const RayBundle bundle = bundleOf(&block, &lanes, 1);
    map.find(bundle, 0.3f, found);
    Vec3Lanes parts[3]; // Henyey and Greenstein's, Draine's, the mixture
    for (int k = 0; k < 3; ++k)
    {
        BeamQuery query = queryOf(rays, 6.0f, 0.3f, droplets.g);
        query.hasDroplets = k > 0;
        for (int i = 0; i < kLanes; ++i)
        {
            query.draineG[i] = droplets.draineG;
            query.draineAlpha[i] = droplets.draineAlpha;
            query.draineShare[i] = k == 1 ? 1.0f : droplets.draineShare;
        }
        gatherBeams(found, bundle, query, parts[k]);
    }
    float most = 0.0f;
    for (int i = 0; i < kLanes; ++i)
    {
        const Vec3 plain = laneOf(parts[0], i), draine = laneOf(parts[1], i);
        const Vec3 mixed = glm::mix(plain, draine, droplets.draineShare);
        most = std::max(most, mixed.x);
        for (int c = 0; c < 3; ++c)
            CHECK(laneOf(parts[2], i)[c] == Approx(mixed[c]).epsilon(1e-4).margin(1e-7));
    }
    CHECK(most > 0.0f);
}

TEST_CASE("beams: one beam and one ray have the light that the phase function of droplets says",
          "[photons][media]")
{
    const Phase droplets = dropletPhase(8.0f);
    PhotonBeam beam;
    beam.origin = Vec3(-2.0f, 0.0f, 0.0f);
    beam.direction = Vec3(1, 0, 0);
    beam.length = 4.0f;
    beam.power = Vec3(1.0f);
    beam.medium = kOutside;
    const BeamMap map({beam}, 0.4f);
    for (const float degrees : {30.0f, 90.0f, 140.0f, 170.0f})
    {
        const float turn = glm::radians(degrees);
        const Vec3 along(std::cos(turn), std::sin(turn), 0.0f); // of the light that is seen
        RayBlock rays;
        for (int i = 0; i < kLanes; ++i)
            setRay(rays, i, plainOf(along * 1.5f), plainOf(-along), 0.0f, 1e30f);
        float found[2];
        for (const int k : {0, 1})
        {
            BeamQuery query = queryOf(rays, 3.0f, 0.1f, k ? droplets.g : 0.0f);
            query.hasDroplets = k == 1;
            for (int i = 0; i < kLanes; ++i)
            {
                query.draineG[i] = droplets.draineG;
                query.draineAlpha[i] = droplets.draineAlpha;
                query.draineShare[i] = droplets.draineShare;
            }
            const RayBlock* block = &rays;
            const LaneMask lanes = kAllLanes;
            BeamPieces pieces;
            const RayBundle bundle = bundleOf(&block, &lanes, 1);
            map.find(bundle, 0.1f, pieces);
            Vec3Lanes radiance;
            gatherBeams(pieces, bundle, query, radiance);
            found[k] = laneOf(radiance, 0).x;
        }
        CAPTURE(degrees);
        REQUIRE(found[0] > 0.0f);
        CHECK(found[1] / found[0] ==
              Approx(evalPhase(droplets, std::cos(turn)) / evalPhase(0.0f, 0.0f)).epsilon(1e-3));
    }
}

TEST_CASE("beams: rays along a beam, and beams without length, stay finite", "[photons][media]")
{
    std::vector<PhotonBeam> beams(3);
    for (PhotonBeam& beam : beams)
    {
        beam.direction = Vec3(0, 0, 1);
        beam.power = Vec3(1.0f);
        beam.length = 5.0f;
    }
    beams[1].direction = glm::normalize(Vec3(1e-4f, 0, 1)); // head on
    beams[2].length = 0.0f;
    RayBlock rays;
    for (int i = 0; i < kLanes; ++i)
        setRay(rays, i, {0, 0, 0}, {0, 0, 1}, 0.0f, 1e30f);
    const BeamQuery query = queryOf(rays, 5.0f, 0.1f);
    const BeamMap map(beams, 1.0f);
    const RayBlock* block = &rays;
    const LaneMask lanes = kAllLanes;
    BeamPieces found;
    const RayBundle bundle = bundleOf(&block, &lanes, 1);
    map.find(bundle, 0.1f, found);
    Vec3Lanes radiance;
    gatherBeams(found, bundle, query, radiance);
    for (int i = 0; i < kLanes; ++i)
        CHECK((radiance.y[i] >= 0.0f && radiance.y[i] < 1e3f));
    BeamMap(std::vector<PhotonBeam>(), 1.0f).find(RayBundle(), 1.0f, found);
    CHECK(found.size() == 0);
}

TEST_CASE("points: look-ups find what all points hold", "[photons][media]")
{
    Uniform random(4);
    std::vector<PhotonPoint> points(3000);
    for (std::size_t k = 0; k < points.size(); ++k)
        points[k] = {Vec3(random(), random(), random()), randomDirection(random),
                     Vec3(random(), random(), random()), MediumId(k % 3), uint32_t(k % 5)};
    const PointMap map(points);
    for (int k = 0; k < 100; ++k)
    {
        PointQuery query;
        query.position = Vec3(random(), random(), random());
        query.towards = randomDirection(random);
        query.radius = 0.02f + 0.2f * random();
        query.phase = k % 2 ? dropletPhase(10.0f) : Phase(0.5f);
        query.medium = 1;
        query.mostEdges = 3;
        Vec3d expected(0.0);
        for (const PhotonPoint& p : points)
        {
            const Vec3 off = p.position - query.position;
            if (p.medium != 1 || p.edges > 3) continue;
            if (!(glm::dot(off, off) < query.radius * query.radius)) continue;
            expected += Vec3d(p.power) *
                        double(evalPhase(query.phase, glm::dot(p.direction, query.towards)));
        }
        expected /= 4.0 / 3.0 * kPiD * std::pow(double(query.radius), 3.0);
        CHECK(double(map.gather(query).x) == Approx(expected.x).epsilon(1e-4).margin(1e-9));
    }
}

// The mean square error after N passes goes with N^-alpha. Each is a mean over 48 x 16 rays; slopes
// of other seeds spread by 0.02, so that a false alarm has a probability below 1e-3.
TEST_CASE("beams: errors fall with the power -0.8 of the passes, and bias vanishes",
          "[photons][statistics][media]")
{
    // A point light of 1 W/sr, 3 away from the foot of a ray of length 10: MEDIA's air light.
    constexpr double kTruth = 0.002346865;
    constexpr int kBeams = 24;
    Squares errors;
    for (uint32_t run = 0; run < 48; ++run)
    {
        Uniform random(100 + run);
        const RayBlock rays = raysAround(random, 3.0f, 5.0f);
        double sums[kLanes] = {};
        int at = 0;
        for (int pass = 0; pass < kCounts[6]; ++pass)
        {
            BeamPieces pieces;
            for (int k = 0; k < kBeams; ++k)
                pieces.add({{0, 0, 0},
                            plainOf(randomDirection(random)),
                            0.0f,
                            90.0f,
                            {float(4.0 * kPiD / kBeams), 1, 1},
                            kOutside,
                            1});
            const auto radius = float(0.5 * beamRadiusScale(pass));
            Vec3Lanes radiance;
            RayBundle everywhere;
            everywhere.radius = kInfinity;
            gatherBeams(pieces, everywhere, queryOf(rays, 10.0f, radius), radiance);
            for (int i = 0; i < kLanes; ++i)
                sums[i] += double(radiance.x[i]);
            if (pass + 1 != kCounts[at]) continue;
            for (const double sum : sums)
                errors.add(at, sum / kCounts[at] / kTruth);
            ++at;
        }
    }
    CAPTURE(errors.slope(), errors.last.mean(), errors.last.standardError());
    CHECK(errors.slope() == Approx(-0.8).margin(0.07));
    CHECK(errors.last.agrees(1.0, 1e-3)); // of bias
    CHECK(errors.last.standardError() < 2e-3);
}

// The expected value of the look-ups of the test above, by the midpoint rule over the directions of
// the beams that pass the ray within the radius.
TEST_CASE("beams: the bias of kernels is below 0.1 % after 4096 passes", "[photons][media]")
{
    constexpr int kAround = 2000,
                  kAcross = 16;            // beams within the plane of light and ray, and off it
    constexpr double kTruth = 0.002346865; // as above
    RayBlock rays;
    for (int i = 0; i < kLanes; ++i)
        setRay(rays, i, {-5, 3, 0}, {1, 0, 0}, 0.0f, 1e30f);
    const auto bias = [&](double radius)
    {
        const double share = radius / 3.0;
        double sum = 0.0;
        for (int k = 0; k < kAround; ++k)
        {
            const double phi = ((k + 0.5) / kAround - 0.5) * kPiD;
            const double most = std::atan(share * std::cos(phi) / std::sqrt(1.0 - share * share));
            BeamPieces pieces;
            for (int j = 0; j < kAcross; ++j)
            {
                const double psi = most * (2.0 * (j + 0.5) / kAcross - 1.0);
                const Vec3d d(std::cos(psi) * std::sin(phi), std::cos(psi) * std::cos(phi),
                              std::sin(psi));
                const double angle = std::cos(psi) * 2.0 * most / kAcross * kPiD / kAround;
                pieces.add(
                    {{0, 0, 0}, plainOf(Vec3(d)), 0.0f, 90.0f, {float(angle), 1, 1}, kOutside, 1});
            }
            Vec3Lanes radiance;
            RayBundle everywhere;
            everywhere.radius = kInfinity;
            gatherBeams(pieces, everywhere, queryOf(rays, 10.0f, float(radius)), radiance);
            sum += double(radiance.x[0]);
        }
        return sum / kTruth - 1.0;
    };
    double squares = 0.0;
    for (int pass = 0; pass < 4096; ++pass)
        squares += beamRadiusScale(pass) * beamRadiusScale(pass) / 4096.0;
    const double first = bias(0.5), later = bias(0.2), mean = first * squares;
    CAPTURE(first, later, mean);
    CHECK(first == Approx(0.00797).margin(3e-4));
    CHECK(later == Approx(first * 0.16).margin(3e-4)); // it goes with the square of the radius
    CHECK(mean == Approx(0.00055).margin(5e-5));
}

TEST_CASE("points: errors fall with the power -4/7 of the passes", "[photons][statistics][media]")
{
    // Scattered radiance over sigmaS, 1 away from a point light of 1 W/sr.
    constexpr int kPoints = 64;
    const double truth = std::exp(-1.0) / (4.0 * kPiD);
    Squares errors;
    for (uint32_t run = 0; run < 24; ++run)
    {
        Uniform random(500 + run);
        PointQuery queries[kLanes];
        double sums[kLanes] = {};
        for (PointQuery& query : queries)
        {
            query.position = randomDirection(random);
            query.towards = Vec3(0, 0, 1);
            query.mostEdges = 9;
        }
        std::vector<PhotonPoint> points(kPoints);
        for (int pass = 0, at = 0; pass < kCounts[6]; ++pass)
        {
            for (PhotonPoint& point : points)
            {
                // A flight in a medium of extinction 1: its power over the density of its end is 1.
                const Vec3 d = randomDirection(random);
                const float t = -std::log1p(-float(random()));
                point = {d * t, d, Vec3(float(4.0 * kPiD / kPoints)), kOutside, 1};
            }
            const auto radius = float(0.4 * pointRadiusScale(pass));
            for (int i = 0; i < kLanes; ++i)
            {
                double sum = 0.0;
                for (const PhotonPoint& point : points)
                {
                    const Vec3 off = point.position - queries[i].position;
                    sum += glm::dot(off, off) < radius * radius ? double(point.power.x) : 0.0;
                }
                sums[i] += sum / (4.0 * kPiD) / (4.0 / 3.0 * kPiD * std::pow(double(radius), 3.0));
            }
            if (pass + 1 != kCounts[at]) continue;
            for (const double sum : sums)
                errors.add(at, sum / kCounts[at] / truth);
            ++at;
        }
    }
    CAPTURE(errors.slope(), errors.last.mean(), errors.last.standardError());
    CHECK(errors.slope() == Approx(-4.0 / 7.0).margin(0.07));
}
