// SkyOpening.cpp - flights vote for a cell, and planes near it are tried. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SkyOpening.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kCells = 48; ///< of the grid, along a side
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
        cell = cellWidth(seen);
        low = 0.5f * (seen.low + seen.high) - Vec3(0.5f * cell * static_cast<float>(kCells));
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

/// Grows a rectangle around the plane's point, by crossings that are no farther than a link from
/// it. Returns the number of crossings in it.
int grow(const PlaneFrame& frame, const std::vector<Flight>& flights, float link,
         PlaneBounds& bounds)
{
    std::vector<Vec2> rest;
    for (const Flight& flight : flights)
    {
        const Vec2 at = crossingOf(frame, flight);
        if (at.x < kInfinity) rest.push_back(at);
    }
    bounds = PlaneBounds{Vec2(0.0f), Vec2(0.0f)};
    int count = 0;
    bool first = true;
    while (true)
    {
        PlaneBounds larger = first ? PlaneBounds() : bounds;
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

/// Keeps the better of a plane's rectangle and the best one so far.
void tryPlane(const PlaneFrame& frame, const std::vector<Flight>& flights, float link,
              SkyOpening& best)
{
    SkyOpening opening{frame, {}, 0, 0.0};
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
SkyOpening openingNear(const std::vector<Flight>& flights, const std::vector<Vec3>& normals,
                       Vec3 at, float cell)
{
    constexpr int kSteps = 6; // planes on each side, half a cell apart
    const Vec3 mean = meanDirection(flights, at, 1.5f * cell);
    SkyOpening best;
    for (const Vec3& axis : normals)
    {
        const float along = glm::dot(axis, mean);
        if (!(std::fabs(along) > 0.2f * glm::length(mean))) continue;
        PlaneFrame frame;
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

} // namespace

Vec2 crossingOf(const PlaneFrame& frame, const Flight& flight)
{
    const float along = glm::dot(flight.direction, frame.normal);
    const float t = glm::dot(frame.at - flight.from, frame.normal) / along;
    if (!(along > 1e-3f) || !(t > 0.0f)) return Vec2(kInfinity);
    const Vec3 d = flight.from + flight.direction * t - frame.at;
    return Vec2(glm::dot(d, frame.axisU), glm::dot(d, frame.axisV));
}

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

float cellWidth(const Seen& seen)
{
    const Vec3 size = seen.high - seen.low;
    const float largest = std::max(size.x, std::max(size.y, size.z));
    return 1.5f * largest / static_cast<float>(kCells); // openings may lie beyond what is seen
}

SkyOpening openingOf(const Seen& seen, const std::vector<Flight>& flights,
                     const std::vector<Vec3>& normals)
{
    Votes votes(seen);
    for (const Flight& flight : flights)
        votes.add(flight);
    return openingNear(flights, normals, votes.mostWanted(), votes.cell);
}

} // namespace osgRayTrace::engine
