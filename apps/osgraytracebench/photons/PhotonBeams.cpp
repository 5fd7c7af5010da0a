// PhotonBeams.cpp - how long it takes to find and add up photon beams for camera rays. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Failure.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/photons/PhotonsMode.h"
#include "osgRayTrace/film/TileLayout.h"
#include "osgRayTrace/photons/BeamMap.h"
#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kSide = 512;   ///< side of the picture whose rays pass the beams [pixels]
constexpr int kBeams = 4096; ///< the default of `photon-beams`
constexpr float kBox = 4.0f; ///< side of the box that the medium fills [length]
constexpr float kSigmaT = 0.25f;
constexpr float kSigmaS = 0.225f;

/// Returns the distance from a point within the box to its wall.
float distanceToWall(Vec3 origin, Vec3 direction)
{
    float distance = kInfinity;
    for (int axis = 0; axis < 3; ++axis)
    {
        const float wall = direction[axis] > 0.0f ? kBox : 0.0f;
        if (direction[axis] != 0.0f)
            distance = std::min(distance, (wall - origin[axis]) / direction[axis]);
    }
    return distance;
}

/// Returns beams from a lamp below the box's ceiling, and those that its walls send back.
std::vector<PhotonBeam> beamsInBox()
{
    std::vector<PhotonBeam> beams;
    for (uint32_t k = 0; beams.size() < kBeams; ++k)
    {
        float u, v, x, y;
        sobol2(k, hash(1), u, v);
        sobol2(k, hash(2), x, y);
        PhotonBeam beam;
        beam.origin = Vec3(kBox * (0.4f + 0.2f * x), kBox * (0.4f + 0.2f * y), kBox * 0.999f);
        const Vec3 down = squareToCosineHemisphere(u, v);
        beam.direction = Vec3(down.x, down.y, -down.z);
        beam.power = Vec3(1.0f / kBeams);
        beam.edges = 1;
        for (uint32_t edge = 0; edge < 3 && beams.size() < kBeams; ++edge)
        {
            beam.length = distanceToWall(beam.origin, beam.direction);
            beams.push_back(beam);
            const Vec3 at = beam.origin + beam.direction * beam.length;
            beam.origin = glm::mix(at, Vec3(0.5f * kBox), 1e-4f);
            sobol2(k, hash(3 + edge), u, v);
            beam.direction = squareToCone(Vec2(u, v), 2.0f);
            if (glm::dot(beam.direction, Vec3(0.5f * kBox) - at) < 0.0f)
                beam.direction = -beam.direction;
            beam.edges += 1;
            beam.power *= 0.6f;
        }
    }
    return beams;
}

/// Returns the rays of a block of a picture that the box fills.
RayBlock raysOf(int tile, int block)
{
    RayBlock rays;
    const Vec3 eye(0.5f * kBox, -1.2f * kBox, 0.5f * kBox);
    for (int i = 0; i < kLanes; ++i)
    {
        const int column = tile % (kSide / kTileSize) * kTileSize + laneX(block, i);
        const int row = tile / (kSide / kTileSize) * kTileSize + laneY(block, i);
        const Vec3 through(kBox * (static_cast<float>(column) + 0.5f) / kSide, 0.0f,
                           kBox * (static_cast<float>(row) + 0.5f) / kSide);
        setRay(rays, i, plainOf(eye), plainOf(glm::normalize(through - eye)), 0.0f, kInfinity);
    }
    return rays;
}

/// Returns what beams scatter towards a ray, beam by beam: the formula of BeamMap.h, in double.
double plainSum(const std::vector<PhotonBeam>& beams, const RayBlock& rays, int lane, float radius)
{
    const Vec3d origin(rays.originX[lane], rays.originY[lane], rays.originZ[lane]);
    const Vec3d d(rays.directionX[lane], rays.directionY[lane], rays.directionZ[lane]);
    double sum = 0.0;
    for (const PhotonBeam& beam : beams)
    {
        const Vec3d b(beam.direction), w = Vec3d(beam.origin) - origin, n = glm::cross(d, b);
        const double sine2 = glm::dot(n, n), sine = std::sqrt(sine2);
        const double along = glm::dot(glm::cross(w, b), n) / sine2;
        const double onBeam = glm::dot(glm::cross(w, d), n) / sine2;
        if (std::abs(glm::dot(w, n)) > double(radius) * sine) continue;
        if (along < 0.0 || onBeam < 0.0 || onBeam >= double(beam.length)) continue;
        const double left = std::exp(-double(kSigmaT) * (along + onBeam));
        sum += double(beam.power.x) * double(kSigmaS) * 0.25 * double(kInvPi) * left /
               (2.0 * double(radius) * std::max(sine, 1e-3));
    }
    return sum;
}

/// Adds up the light of all beams for each pixel, as path tracing does: a tile's beams are found
/// once, and tested for each of its blocks. Returns the sum over the pixels that are compared, a
/// row of each of some tiles, and sets expected to what it should be.
double gatherPicture(const BeamMap& map, float radius, const std::vector<PhotonBeam>* compared,
                     double& expected)
{
    BeamQuery query;
    query.lanes = kAllLanes;
    query.mostEdges = 8;
    query.radius = radius;
    for (int i = 0; i < kLanes; ++i)
    {
        query.begin[i] = 0.0f;
        query.end[i] = kInfinity;
        query.anisotropy[i] = 0.0f;
        query.medium[i] = kOutside;
        setLane(query.sigmaT, i, Vec3(kSigmaT));
        setLane(query.sigmaS, i, Vec3(kSigmaS));
    }
    const LaneMask all = kAllLanes;
    BeamPieces found;
    double sum = 0.0;
    expected = 0.0;
    for (int tile = 0; tile < kSide * kSide / kTilePixels; ++tile)
    {
        RayBlock rays[kTileBlocks];
        const RayBlock* blocks[kTileBlocks];
        LaneMask lanes[kTileBlocks];
        for (int b = 0; b < kTileBlocks; ++b)
        {
            rays[b] = raysOf(tile, b);
            blocks[b] = &rays[b];
            lanes[b] = kAllLanes;
        }
        map.find(bundleOf(blocks, lanes, kTileBlocks), radius, found);
        for (int b = 0; b < kTileBlocks; ++b)
        {
            query.ray = &rays[b];
            Vec3Lanes radiance;
            gatherBeams(found, bundleOf(&query.ray, &all, 1), query, radiance);
            if (tile % 37 != 0 || b % 5 != 0) continue;
            for (int i = 0; i < kLanes; ++i)
            {
                sum += double(radiance.y[i]);
                if (compared) expected += plainSum(*compared, rays[b], i, radius);
            }
        }
    }
    return sum;
}

} // namespace

void measurePhotonBeams(const PhotonsOptions& options, Rows& rows)
{
    const std::vector<PhotonBeam> beams = beamsInBox();
    const float piece = 0.15f * std::sqrt(0.75f) * kBox; // as PhotonPasses.cpp cuts them
    const BeamMap map(beams, piece);
    for (const float part : {0.001f, 0.005f})
    {
        const float radius = part * kBox;
        double expected = 0.0;
        const double sum = gatherPicture(map, radius, &beams, expected);
        if (std::abs(sum - expected) > 1e-3 * expected)
            throw app::Failure(app::kCannotRender, "beams do not add up as they do one by one");
        std::vector<double> seconds;
        for (int run = 0; run < options.runs; ++run)
            seconds.push_back(
                threadSecondsOf([&] { gatherPicture(map, radius, nullptr, expected); }));
        const std::string name = "beams r " + std::to_string(part).substr(0, 5);
        rows.push_back({name + " of the box: 4096 beams, 512 x 512 rays, 1 thread",
                        median(seconds) * 1e3, "ms", Goal::AtMost, 60.0});
    }
    std::vector<double> seconds;
    for (int run = 0; run < options.runs; ++run)
        seconds.push_back(threadSecondsOf([&] { BeamMap(beams, piece); }));
    rows.push_back({"beams: map of 4096, 1 thread", median(seconds) * 1e3, "ms"});
}

} // namespace osgRayTrace::bench
