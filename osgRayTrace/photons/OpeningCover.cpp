// OpeningCover.cpp - covers the flights of photons by spheres where they come together. Layer:
// photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/OpeningCover.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace osgRayTrace::engine
{

namespace
{

/// Calls f with the cells that a flight crosses, in order.
template <class F> void forCells(const Grid& grid, const PhotonFlight& flight, const F& f)
{
    const Vec3 way = flight.to - flight.from;
    const float length = glm::length(way) * grid.scale;
    const int steps = static_cast<int>(std::min(length * 4.0f, 4096.0f)) + 1;
    uint32_t last = ~0u;
    for (int s = 0; s <= steps; ++s)
    {
        const uint32_t cell =
            grid.cellOf(flight.from + way * (static_cast<float>(s) / static_cast<float>(steps)));
        if (cell != last) f(cell);
        last = cell;
    }
}

/// Returns whether a flight crosses a sphere.
bool crosses(Vec3 centre, float radius, const PhotonFlight& flight)
{
    const Vec3 d = centre - flight.from, way = flight.to - flight.from;
    const float along = glm::dot(d, way) / glm::dot(way, way);
    if (!(along > 0.0f && along < 1.0f)) return false;
    const Vec3 off = d - way * along;
    return glm::dot(off, off) <= radius * radius;
}

/// One of so many flights tells the flux towards the openings.
constexpr std::size_t kFluxStride = 8;

/// Flights within so many radii tell the axis of an opening.
constexpr float kAxisRadius = 4.0f;

/// Returns the mean way of the flights around a place, of any length.
Vec3 axisAround(Vec3 centre, float radius, const std::vector<UsefulFlight>& flights)
{
    Vec3 sum(0.0f);
    for (const UsefulFlight& useful : flights)
        if (crosses(centre, radius, *useful.flight))
            sum += static_cast<float>(useful.use) *
                   glm::normalize(useful.flight->to - useful.flight->from);
    return sum;
}

/// Turns an axis until the flights that cross a place go along it, but for stray ones.
Vec3 turnedToAll(Vec3 axis, Vec3 centre, float radius, const std::vector<UsefulFlight>& flights,
                 const std::vector<uint32_t>& crossing)
{
    constexpr int kTurns = 64;
    constexpr float kStep = 0.05f, kAlong = 0.05f, kStray = -0.5f;
    std::vector<Vec3> ways;
    for (const uint32_t k : crossing)
        if (crosses(centre, radius, *flights[k].flight))
            ways.push_back(glm::normalize(flights[k].flight->to - flights[k].flight->from));
    for (int turn = 0; turn < kTurns; ++turn)
    {
        float least = kAlong;
        const Vec3* worst = nullptr;
        for (const Vec3& way : ways)
        {
            const float along = glm::dot(way, axis);
            if (!(along > kStray && along < least)) continue;
            least = along;
            worst = &way;
        }
        if (!worst) break;
        axis = glm::normalize(axis + kStep * *worst);
    }
    return axis;
}

/// Returns the mean of the points of flights that are nearest to a place.
Vec3 middleOf(Vec3 place, const std::vector<UsefulFlight>& flights,
              const std::vector<uint32_t>& crossing)
{
    Vec3 sum(0.0f);
    float all = 0.0f;
    for (const uint32_t k : crossing)
    {
        const PhotonFlight& flight = *flights[k].flight;
        const Vec3 way = glm::normalize(flight.to - flight.from);
        const auto use = static_cast<float>(flights[k].use);
        sum += use * (flight.from + way * glm::dot(place - flight.from, way));
        all += use;
    }
    return all > 0.0f ? sum / all : place;
}

} // namespace

bool crosses(const PhotonOpening& opening, const PhotonFlight& flight)
{
    return glm::dot(opening.centre - flight.from, opening.axis) > 0.0f &&
           crosses(opening.centre, opening.radius, flight);
}

double coverFlights(const Grid& grid, const std::vector<UsefulFlight>& flights,
                    const CoverRules& rules, std::vector<bool>& held,
                    std::vector<PhotonOpening>& openings)
{
    struct Cell
    {
        std::vector<uint32_t> flights;
        double use = 0.0; ///< of the flights that no opening holds yet
        double all = 0.0; ///< of all flights
    };
    std::unordered_map<uint32_t, uint32_t> indices;
    std::vector<std::pair<uint32_t, Cell>> cells;
    double all = 0.0, sum = 0.0;
    for (uint32_t k = 0; k < flights.size(); ++k)
    {
        all += flights[k].use;
        if (held[k]) sum += flights[k].use;
        if (held[k]) continue;
        forCells(grid, *flights[k].flight,
                 [&](uint32_t number)
                 {
                     const auto place =
                         indices.emplace(number, static_cast<uint32_t>(cells.size()));
                     if (place.second) cells.push_back({number, {}});
                     Cell& cell = cells[place.first->second].second;
                     cell.flights.push_back(k);
                     cell.use += flights[k].use;
                     cell.all += flights[k].use;
                 });
    }
    double most = 0.0;
    for (const auto& cell : cells)
        most = std::max(most, cell.second.all);
    std::vector<uint32_t> major; // the cells that may have openings
    for (uint32_t k = 0; k < cells.size(); ++k)
        if (cells[k].second.all >= rules.leastUse * most) major.push_back(k);
    while (!major.empty() && openings.size() < rules.mostOpenings && sum < rules.wantedHeld * all)
    {
        const auto place = std::max_element(major.begin(), major.end(),
                                            [&](uint32_t a, uint32_t b)
                                            { return cells[a].second.use < cells[b].second.use; });
        const auto best = cells.begin() + *place;
        if (!(best->second.use > 1e-4 * all)) break;
        PhotonOpening opening;
        opening.centre = middleOf(grid.centreOf(best->first), flights, best->second.flights);
        opening.radius = rules.radius / grid.scale;
        opening.axis = axisAround(opening.centre, kAxisRadius * opening.radius, flights);
        const float length = glm::length(opening.axis);
        best->second.use = 0.0;
        if (!(length > 0.0f))
        {
            major.erase(place);
            continue;
        }
        opening.axis /= length;
        opening.axis = turnedToAll(opening.axis, opening.centre, opening.radius, flights,
                                   best->second.flights);
        openings.push_back(opening);
        for (uint32_t k = 0; k < flights.size(); ++k)
        {
            if (held[k] || !crosses(opening, *flights[k].flight)) continue;
            held[k] = true;
            sum += flights[k].use;
            forCells(grid, *flights[k].flight,
                     [&](uint32_t number) { cells[indices[number]].second.use -= flights[k].use; });
        }
    }
    return sum / all;
}

OpeningFlux fluxOf(const std::vector<PhotonOpening>& openings,
                   const std::vector<PhotonFlight>& flights)
{
    OpeningFlux result;
    const PhotonOpenings plain(openings, 1.0f);
    for (std::size_t first = 0; first < flights.size(); first += kLanes * kFluxStride)
    {
        PhotonOpenings::Views views = {};
        FloatLanes power = {};
        for (int i = 0; i < kLanes; ++i)
        {
            const std::size_t k = first + static_cast<std::size_t>(i) * kFluxStride;
            if (k >= flights.size()) break;
            setLane(views.position, i, flights[k].to);
            setLane(views.normal, i, flights[k].normal);
            power[i] = flights[k].power;
            result.through += std::any_of(openings.begin(), openings.end(),
                                          [&](const PhotonOpening& opening)
                                          { return crosses(opening, flights[k]); });
        }
        plain.look(power, kAllLanes, views);
        for (int i = 0; i < kLanes; ++i)
            result.towards += static_cast<double>(views.flux[i] * power[i]);
    }
    result.towards *= static_cast<double>(kFluxStride);
    result.through *= static_cast<double>(kFluxStride) / static_cast<double>(flights.size());
    return result;
}

} // namespace osgRayTrace::engine
