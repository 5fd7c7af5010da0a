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
#include "osgRayTrace/integrators/shared/SkyFlights.h"
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
constexpr int kCells = 48;         ///< of the grid, along a side
constexpr int kMostNormals = 8;

/// The votes of flights for cells.
struct Votes
{
    Vec3 low{0.0f};
    float cell = 0.0f; ///< width [engine units]
    std::vector<uint64_t> blocks;

    Votes(const Seen& seen)
    {
        static_assert(kFlightBlocks <= 64, "a bit for each block");
        const Vec3 size = seen.high - seen.low;
        const float largest = std::max(size.x, std::max(size.y, size.z));
        const float half = 0.75f * largest; // openings may lie beyond what is seen
        cell = 2.0f * half / static_cast<float>(kCells);
        low = 0.5f * (seen.low + seen.high) - Vec3(half);
        blocks.resize(std::size_t(kCells) * kCells * kCells);
    }

    void add(const Flight& flight)
    {
        const Vec3 begin = (flight.from - low) / cell;
        const Vec3 step = flight.direction * 0.5f;
        for (int k = 1; k < 4 * kCells; ++k)
        {
            const Vec3 at = glm::floor(begin + step * static_cast<float>(k));
            const auto inside = [](float x) { return x >= 0.0f && x < float(kCells); };
            if (!inside(at.x) || !inside(at.y) || !inside(at.z)) return;
            const auto index = static_cast<std::size_t>((at.z * kCells + at.y) * kCells + at.x);
            blocks[index] |= uint64_t(1) << flight.block;
        }
    }

    /// Returns the middle of the cell with most votes; of several, the first one.
    Vec3 mostWanted() const
    {
        std::size_t best = 0;
        int most = 0;
        for (std::size_t k = 0; k < blocks.size(); ++k)
        {
            if (!blocks[k]) continue;
            const int votes = countBits(static_cast<uint32_t>(blocks[k])) +
                              countBits(static_cast<uint32_t>(blocks[k] >> 32));
            if (votes > most) best = k;
            most = std::max(most, votes);
        }
        const auto x = static_cast<float>(best % kCells),
                   y = static_cast<float>(best / kCells % kCells),
                   z = static_cast<float>(best / kCells / kCells);
        return low + (Vec3(x, y, z) + 0.5f) * cell;
    }
};

/// Returns axes across which the scene has surfaces, those of most pixels first.
std::vector<Vec3> normalsOf(const Seen& seen)
{
    struct Axis
    {
        Vec3 direction;
        int count;
    };
    std::vector<Axis> axes;
    for (const SeenBlock& block : seen.blocks)
        for (const int i : lanesIn(block.lanes))
        {
            const Vec3 n = laneOf(block.surface.geometricNormal, i);
            const auto same = std::find_if(
                axes.begin(), axes.end(),
                [&](const Axis& axis) { return std::fabs(glm::dot(axis.direction, n)) > 0.99f; });
            if (same != axes.end())
                ++same->count;
            else
                axes.push_back({n, 1});
        }
    std::stable_sort(axes.begin(), axes.end(),
                     [](const Axis& a, const Axis& b) { return a.count > b.count; });
    std::vector<Vec3> normals;
    for (std::size_t k = 0; k < axes.size() && k < kMostNormals; ++k)
        normals.push_back(axes[k].direction);
    return normals;
}

/// A plane with axes, and a rectangle on it.
struct Frame
{
    Vec3 at, axisU, axisV, normal;
};

struct Bounds
{
    Vec2 low{kInfinity}, high{-kInfinity};

    void add(Vec2 p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool holds(Vec2 p, float margin) const
    {
        return p.x >= low.x - margin && p.x <= high.x + margin && p.y >= low.y - margin &&
               p.y <= high.y + margin;
    }
    float area() const { return (high.x - low.x) * (high.y - low.y); }
};

/// Returns where a flight crosses the plane along its normal; infinite: it does not.
Vec2 crossingOf(const Frame& frame, const Flight& flight)
{
    const float along = glm::dot(flight.direction, frame.normal);
    const float t = glm::dot(frame.at - flight.from, frame.normal) / along;
    if (!(along > 1e-3f) || !(t > 0.0f)) return Vec2(kInfinity);
    const Vec3 d = flight.from + flight.direction * t - frame.at;
    return Vec2(glm::dot(d, frame.axisU), glm::dot(d, frame.axisV));
}

/// Grows a rectangle around the plane's point, by crossings that are no farther than a link from
/// it. Returns the number of crossings in it.
int grow(const Frame& frame, const std::vector<Flight>& flights, float link, Bounds& bounds)
{
    std::vector<Vec2> rest;
    for (const Flight& flight : flights)
    {
        const Vec2 at = crossingOf(frame, flight);
        if (at.x < kInfinity) rest.push_back(at);
    }
    bounds = Bounds{Vec2(0.0f), Vec2(0.0f)};
    int count = 0;
    bool first = true;
    while (true)
    {
        Bounds larger = first ? Bounds() : bounds;
        const auto outside = std::stable_partition(
            rest.begin(), rest.end(), [&](Vec2 at) { return !bounds.holds(at, link); });
        const auto added = static_cast<int>(rest.end() - outside);
        for (auto at = outside; at != rest.end(); ++at)
            larger.add(*at);
        rest.erase(outside, rest.end());
        if (added == 0) return count;
        count += added;
        bounds = larger;
        first = false;
    }
}

struct Opening
{
    Frame frame;
    Bounds bounds;
    int count = 0;
    double worth = 0.0; ///< how crowded the flights are in it
};

/// Keeps the better of a plane's rectangle and the best one so far.
void tryPlane(const Frame& frame, const std::vector<Flight>& flights, float link, Opening& best)
{
    Opening opening{frame, {}, 0, 0.0};
    opening.count = grow(frame, flights, link, opening.bounds);
    if (opening.count < 3 || !(opening.bounds.area() > 0.0f)) return;
    opening.worth = double(opening.count) * opening.count / double(opening.bounds.area());
    if (opening.worth > best.worth) best = opening;
}

/// Returns the mean direction of flights that pass near a point.
Vec3 meanDirection(const std::vector<Flight>& flights, Vec3 at, float near)
{
    Vec3 sum(0.0f);
    for (const Flight& flight : flights)
    {
        const Vec3 d = at - flight.from;
        const float along = glm::dot(d, flight.direction);
        if (along > 0.0f && glm::dot(d, d) - along * along < near * near) sum += flight.direction;
    }
    return sum;
}

/// Returns the best rectangle among those on planes near a point.
Opening openingNear(const std::vector<Flight>& flights, const std::vector<Vec3>& normals, Vec3 at,
                    float cell)
{
    constexpr int kSteps = 6; // planes on each side, half a cell apart
    const Vec3 mean = meanDirection(flights, at, 1.5f * cell);
    Opening best;
    for (const Vec3& axis : normals)
    {
        const float along = glm::dot(axis, mean);
        if (!(std::fabs(along) > 0.2f * glm::length(mean))) continue;
        Frame frame;
        frame.normal = along > 0.0f ? axis : -axis;
        frameOf(frame.normal.x, frame.normal.y, frame.normal.z, frame.axisU, frame.axisV);
        for (const Vec3& other : normals)
        {
            const Vec3 across = other - frame.normal * glm::dot(other, frame.normal);
            if (!(glm::length(across) > 0.3f)) continue;
            frame.axisU = glm::normalize(across);
            frame.axisV = glm::cross(frame.normal, frame.axisU);
            break;
        }
        for (int k = -kSteps; k <= kSteps; ++k)
        {
            frame.at = at + frame.normal * (0.5f * cell * static_cast<float>(k));
            tryPlane(frame, flights, 1.5f * cell, best);
        }
    }
    return best;
}

RectangleLight rectangleOf(const Frame& frame, const Bounds& bounds)
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
void sendThrough(const PassContext& context, const Seen& seen, const Opening& opening,
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
            const Frame& frame = opening.frame;
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
            Opening& opening)
{
    constexpr int kSteps = 8;
    constexpr float kAsGood = 1.1f;
    constexpr float kMostlyCrossed = 0.9f;
    constexpr float kRim = 0.03f; // light may cross where no ray from what is seen did
    const Vec2 margin = 0.1f * (opening.bounds.high - opening.bounds.low) + 0.5f * cell;
    Opening wider = opening;
    wider.bounds.low -= margin;
    wider.bounds.high += margin;
    std::vector<Flight> flights;
    sendThrough(context, seen, wider, counts, flights);
    if (flights.size() < kLeastFlights) return;
    const Vec3 at = opening.frame.at;
    std::array<Opening, 2 * kSteps + 1> planes;
    int most = 0;
    for (int k = -kSteps; k <= kSteps; ++k)
    {
        Opening& moved = planes[static_cast<std::size_t>(k + kSteps)];
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
    const auto isCrossed = [most](const Opening& plane)
    { return static_cast<float>(plane.count) >= kMostlyCrossed * static_cast<float>(most); };
    float least = kInfinity;
    for (const Opening& plane : planes)
        if (isCrossed(plane)) least = std::min(least, plane.bounds.area());
    // The outermost of the planes that are as good: reveals are then on the inner side.
    for (const Opening& plane : planes)
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
    const auto all = static_cast<float>(flights.size());
    std::vector<RectangleLight> rectangles;
    while (rectangles.size() < SkyPortals::kMost &&
           static_cast<float>(flights.size()) > 0.02f * all && flights.size() >= 3)
    {
        Votes votes(seen);
        for (const Flight& flight : flights)
            votes.add(flight);
        Opening opening = openingNear(flights, normals, votes.mostWanted(), votes.cell);
        if (!(opening.worth > 0.0)) break;
        refine(context, seen, votes.cell, counts, opening);
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
