// SkyPortalFinder.cpp - rectangles around rays that have met the sky. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// 1. Points that the camera sees, and points around these, send rays like Lambert's surfaces. Those
//    that meet the sky are flights.
//    Points that find much of the sky lie outside, or so near an opening that they need no help.
// 2. A flight votes in each cell of a grid that it crosses, but all flights of the points of one
//    block together have one vote. The cell with most votes lies in an opening.
// 3. Planes through places near this cell, across directions in which the scene has surfaces, are
//    tried. On each of them grows the rectangle around the flights that cross it next to the cell.
//    The plane that has most flights in the least area is that of the opening.
// 4. More rays through a somewhat larger rectangle show its borders.
// 5. The flights through the rectangle are taken away, and the next opening is looked for.
#include "osgRayTrace/integrators/shared/SkyPortalFinder.h"

#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/SkyOpening.h"
#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kFirstRounds = 4; ///< rays of a point before it is known whether any is of use
/// Points of which this share of the rays or more finds the sky may lie outside.
constexpr float kOutdoors = 0.3f;
constexpr float kLeastIndoors = 0.25f; ///< share of the points; with fewer, the view is of outdoors
/// Share of the rays that find the sky without help. In a Cornell box that is open to a sky the
/// share is higher, and paths need less time for the same error if they know no portals.
constexpr float kEasyToFind = 0.05f;
constexpr std::size_t kLeastFlights = 24;
constexpr float kLeastHeld = 0.9f; ///< share of the flights that cross portals

RectangleLight rectangleOf(const PlaneFrame& frame, const PlaneBounds& bounds)
{
    RectangleLight r;
    r.axisU = plainOf(frame.axisU);
    r.axisV = plainOf(frame.axisV);
    r.normal = plainOf(frame.normal);
    r.corner = plainOf(frame.at + frame.axisU * bounds.low.x + frame.axisV * bounds.low.y);
    r.width = bounds.high.x - bounds.low.x;
    r.height = bounds.high.y - bounds.low.y;
    return r;
}

/// Sends rays through a rectangle, and adds those that meet the sky to the flights.
void sendThrough(const PassContext& context, const Seen& seen, const SkyOpening& opening,
                 TileCounts& counts, std::vector<Flight>& flights)
{
    for (std::size_t b = 0; b < seen.blocks.size(); ++b)
    {
        const SeenBlock& block = seen.blocks[b];
        LightLanes samples;
        for (const int i : lanesIn(block.lanes))
        {
            float u, v;
            sobol2(static_cast<uint32_t>(b) * kLanes + static_cast<uint32_t>(i), kFlightSeed, u, v);
            const PlaneFrame& frame = opening.frame;
            const Vec2 at =
                opening.bounds.low + (opening.bounds.high - opening.bounds.low) * Vec2(u, v);
            const Vec3 d = frame.at + frame.axisU * at.x + frame.axisV * at.y -
                           laneOf(block.surface.position, i);
            if (glm::dot(d, frame.normal) > 0.0f) setFlight(block, i, glm::normalize(d), samples);
        }
        addFlights(context, block, static_cast<int>(b), samples, counts, flights);
    }
}

/// Sets the borders of an opening to those of rays through a larger rectangle.
void refine(const PassContext& context, const Seen& seen, float cell, TileCounts& counts,
            SkyOpening& opening)
{
    constexpr int kSteps = 8;
    constexpr float kAsGood = 1.1f;
    constexpr float kMostlyCrossed = 0.9f;
    constexpr float kRim = 0.03f; // light may cross where no ray from what is seen did
    const Vec2 margin = 0.1f * (opening.bounds.high - opening.bounds.low) + 0.5f * cell;
    SkyOpening wider = opening;
    wider.bounds.low -= margin;
    wider.bounds.high += margin;
    std::vector<Flight> flights;
    sendThrough(context, seen, wider, counts, flights);
    if (flights.size() < kLeastFlights) return;
    const Vec3 at = opening.frame.at;
    std::array<SkyOpening, 2 * kSteps + 1> planes;
    int most = 0;
    for (int k = -kSteps; k <= kSteps; ++k)
    {
        SkyOpening& moved = planes[static_cast<std::size_t>(k + kSteps)];
        moved.frame = opening.frame;
        moved.frame.at = at + opening.frame.normal * (0.125f * cell * static_cast<float>(k));
        for (const Flight& flight : flights)
        {
            const Vec2 crossing = crossingOf(moved.frame, flight);
            if (!(crossing.x < kInfinity)) continue;
            moved.bounds.add(crossing);
            ++moved.count;
        }
        most = std::max(most, moved.count);
    }
    // Few flights cross a plane that what is seen lies beyond.
    const auto isCrossed = [most](const SkyOpening& plane)
    { return static_cast<float>(plane.count) >= kMostlyCrossed * static_cast<float>(most); };
    float least = kInfinity;
    for (const SkyOpening& plane : planes)
        if (isCrossed(plane)) least = std::min(least, plane.bounds.area());
    // The outermost of the planes that are as good: reveals are then on the inner side.
    for (const SkyOpening& plane : planes)
        if (isCrossed(plane) && plane.bounds.area() <= kAsGood * least) opening = plane;
    const Vec2 rim = kRim * (opening.bounds.high - opening.bounds.low);
    opening.bounds.low -= rim;
    opening.bounds.high += rim;
}

/// Returns whether light goes the same way in both directions, and spots on Lambert's surfaces send
/// the same radiance to all sides.
bool lightsSpots(const TracedScene& traced)
{
    const SceneTraits& traits = traced.traits();
    if (traits.blended || traits.normalMaps || traits.attenuation || traits.subsurface)
        return false;
    for (std::size_t k = 0; k < traced.scene().materials.size(); ++k)
    {
        const Material& m = traced.scene().materials[k];
        const bool oneWay = m.cullsAllRays || m.alphaTest != AlphaTest::Always;
        if (oneWay && traced.materials()[static_cast<uint32_t>(k)].partial) return false;
    }
    return true;
}

/// A point of which many rays find the sky.
struct BrightPoint
{
    Vec3 position;
    int sent, found; ///< rays, and those that met the sky
};

/// Takes points off what is seen if many of their rays find the sky, and takes off their flights:
/// ground and houses outside would hide the opening.
void takeBrightPoints(Vec3 eye, Seen& seen, std::vector<Flight>& flights,
                      std::vector<BrightPoint>& taken)
{
    std::vector<std::array<int, kLanes>> found(seen.blocks.size());
    for (const Flight& flight : flights)
        ++found[static_cast<std::size_t>(flight.block)][static_cast<std::size_t>(flight.lane)];
    for (std::size_t b = 0; b < seen.blocks.size(); ++b)
        for (const int i : lanesIn(seen.blocks[b].lanes))
        {
            SeenBlock& block = seen.blocks[b];
            const int hits = found[b][static_cast<std::size_t>(i)];
            if (hits == 0 || float(hits) < kOutdoors * float(block.sent[i])) continue;
            taken.push_back({laneOf(block.surface.position, i), block.sent[i], hits});
            block.lanes &= ~(1u << i);
        }
    const auto isTaken = [&seen](const Flight& flight)
    { return !((seen.blocks[static_cast<std::size_t>(flight.block)].lanes >> flight.lane) & 1u); };
    flights.erase(std::remove_if(flights.begin(), flights.end(), isTaken), flights.end());
    setBounds(eye, seen);
}

int pointsIn(const Seen& seen)
{
    int count = 0;
    for (const SeenBlock& block : seen.blocks)
        count += countLanes(block.lanes);
    return count;
}

int raysFrom(const Seen& seen)
{
    int count = 0;
    for (const SeenBlock& block : seen.blocks)
        for (const int i : lanesIn(block.lanes))
            count += block.sent[i];
    return count;
}

bool isOutside(const std::vector<RectangleLight>& rectangles, Vec3 point)
{
    return std::any_of(rectangles.begin(), rectangles.end(),
                       [point](const RectangleLight& r)
                       { return dot(r.normal, plainOf(point) - r.corner) > 0.0f; });
}

} // namespace

std::shared_ptr<const SkyPortals> findSkyPortals(const PassContext& context, TileCounts& counts)
{
    Seen seen = lookAround(context, counts);
    const auto least = kLeastIndoors * static_cast<float>(pointsIn(seen));
    std::vector<Flight> flights;
    std::vector<BrightPoint> bright;
    const auto isOfUse = [&](std::size_t leastFlights)
    {
        takeBrightPoints(context.eye, seen, flights, bright);
        return flights.size() >= leastFlights && static_cast<float>(pointsIn(seen)) > least &&
               static_cast<float>(flights.size()) <= kEasyToFind * float(raysFrom(seen));
    };
    sendAround(context, seen, 0, kFirstRounds, counts, flights);
    if (!isOfUse(1)) return nullptr;
    sendAround(context, seen, kFirstRounds, kFlightRounds, counts, flights);
    if (!isOfUse(kLeastFlights)) return nullptr;
    int sent = raysFrom(seen), found = static_cast<int>(flights.size());

    const std::vector<Vec3> normals = normalsOf(seen);
    const float cell = cellWidth(seen);
    const auto all = static_cast<float>(flights.size());
    std::vector<RectangleLight> rectangles;
    while (rectangles.size() < SkyPortals::kMost &&
           static_cast<float>(flights.size()) > 0.02f * all && flights.size() >= 3)
    {
        SkyOpening opening = openingOf(seen, flights, normals);
        if (!(opening.worth > 0.0)) break;
        refine(context, seen, cell, counts, opening);
        if (!(opening.bounds.area() > 0.0f && opening.bounds.area() < kInfinity)) break;
        const auto before = flights.size();
        flights.erase(std::remove_if(flights.begin(), flights.end(),
                                     [&](const Flight& flight)
                                     {
                                         const Vec2 at = crossingOf(opening.frame, flight);
                                         return opening.bounds.holds(at, 0.0f);
                                     }),
                      flights.end());
        if (flights.size() == before) break;
        rectangles.push_back(rectangleOf(opening.frame, opening.bounds));
    }
    if (static_cast<float>(flights.size()) > (1.0f - kLeastHeld) * all) return nullptr;
    // Points near the open side of a box are in it, and their rays count.
    for (const BrightPoint& point : bright)
    {
        if (isOutside(rectangles, point.position)) continue;
        sent += point.sent;
        found += point.found;
    }
    if (static_cast<float>(found) > kEasyToFind * static_cast<float>(sent)) return nullptr;
    const bool spots = lightsSpots(*context.traced);
    const bool hasSun = context.options.environmentSampling == EnvironmentSampling::Importance &&
                        !context.traced->lights().shiningEnvironment()->isEven();
    std::vector<PaneSide> panes;
    if (spots && hasSun && context.traced->traits().panes)
        panes = panesOf(context, rectangles, counts);
    return std::make_shared<const SkyPortals>(std::move(rectangles), spots, std::move(panes));
}

} // namespace osgRayTrace::engine
