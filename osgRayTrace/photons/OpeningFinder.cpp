// OpeningFinder.cpp - finds small openings that light comes through to what views see. Layer:
// photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/OpeningFinder.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace osgRayTrace::engine
{

namespace
{

/// Cells along a side of the cube around the scene: of surfaces, of places that flights begin at,
/// and of openings, of which the finest is tried first.
constexpr uint32_t kSurfaceCells = 32, kStartCells = 16;
constexpr uint32_t kOpeningCells[] = {64, 32};

constexpr std::size_t kMostOpenings = 64;

/// A flight is found through openings if it is so many times as useful as flights from around its
/// start are in the mean.
constexpr double kRare = 8.0;

/// Openings hold at least this share of the use of such flights.
constexpr double kLeastHeld = 0.75, kWantedHeld = 0.998;

/// The cell of an opening holds at least this share of what the cell of the best one holds.
constexpr double kLeastUse = 0.15;

/// The radius of an opening over the side of its cell: the sphere holds the cell, and a margin.
constexpr float kOpeningRadius = 1.0f;

/// Flights within so many radii tell the axis of an opening.
constexpr float kAxisRadius = 4.0f;

/// Flights from which openings are found, at least.
constexpr std::size_t kLeastFlights = 16;

/// The expected number of children of a photon, all its surfaces together, if nothing limits it.
constexpr double kChildren = 1.0;

/// One of so many flights tells the flux towards the openings.
constexpr std::size_t kFluxStride = 8;

/// Openings are small if no more than this share of all flights goes through them.
constexpr double kMostThrough = 0.035;

/// The cube around a scene, cut into cells.
struct Grid
{
    Grid(const Sphere& scene, uint32_t cells)
        : low(scene.centre - Vec3(scene.radius)),
          scale(static_cast<float>(cells) / (2.0f * scene.radius)),
          count(cells)
    {
    }

    uint32_t along(float x) const
    {
        const float cell = x * scale;
        if (!(cell > 0.0f)) return 0;
        return cell < static_cast<float>(count) ? static_cast<uint32_t>(cell) : count - 1;
    }
    uint32_t cellOf(Vec3 p) const
    {
        return (along(p.z - low.z) * count + along(p.y - low.y)) * count + along(p.x - low.x);
    }
    Vec3 centreOf(uint32_t cell) const
    {
        const Vec3 index(static_cast<float>(cell % count), static_cast<float>(cell / count % count),
                         static_cast<float>(cell / count / count));
        return low + (index + Vec3(0.5f)) / scale;
    }

    Vec3 low;
    float scale;
    uint32_t count;
};

uint32_t octantOf(Vec3 n)
{
    return (n.x < 0.0f) | (n.y < 0.0f) << 1 | (n.z < 0.0f) << 2;
}

uint32_t surfaceCell(const Grid& grid, Vec3 p, Vec3 n)
{
    return grid.cellOf(p) * 8 + octantOf(n);
}

struct UsefulFlight
{
    const PhotonFlight* flight;
    double use;
};

/// Limits the use of flights to that above which half of all use is: a few flights to places that
/// few have found would count for all others.
void limitUses(std::vector<UsefulFlight>& flights)
{
    std::vector<double> uses;
    double all = 0.0, sum = 0.0;
    for (const UsefulFlight& flight : flights)
    {
        uses.push_back(flight.use);
        all += flight.use;
    }
    std::sort(uses.begin(), uses.end());
    double most = 0.0;
    for (auto use = uses.rbegin(); use != uses.rend() && sum < 0.5 * all; ++use)
        sum += most = *use;
    for (UsefulFlight& flight : flights)
        flight.use = std::min(flight.use, most);
}

/// Returns the flights that are much more useful than others from around their start. A further
/// photon takes the more off the relative error of a cell, the fewer there are.
std::vector<UsefulFlight> rareFlights(const Sphere& scene, const std::vector<PhotonFlight>& flights,
                                      const std::vector<SeenPoint>& seen)
{
    const Grid surfaces(scene, kSurfaceCells), starts(scene, kStartCells);
    std::vector<float> looks(std::size_t(8) * kSurfaceCells * kSurfaceCells * kSurfaceCells);
    std::vector<float> hits(looks.size());
    for (const SeenPoint& point : seen)
        ++looks[surfaceCell(surfaces, point.position, point.normal)];
    for (const PhotonFlight& flight : flights)
        if (flight.stored) ++hits[surfaceCell(surfaces, flight.to, flight.normal)];
    const auto useOf = [&](const PhotonFlight& flight)
    {
        if (!flight.stored) return 0.0;
        const uint32_t cell = surfaceCell(surfaces, flight.to, flight.normal);
        const double dense = static_cast<double>(hits[cell]) + 4.0;
        return static_cast<double>(looks[cell]) / (dense * dense);
    };
    std::vector<double> uses(std::size_t(kStartCells) * kStartCells * kStartCells);
    std::vector<double> counts(uses.size());
    for (const PhotonFlight& flight : flights)
    {
        const uint32_t start = starts.cellOf(flight.from);
        uses[start] += useOf(flight);
        counts[start] += 1.0;
    }
    std::vector<UsefulFlight> rare;
    for (const PhotonFlight& flight : flights)
    {
        const double use = useOf(flight);
        const uint32_t start = starts.cellOf(flight.from);
        if (use > kRare * uses[start] / counts[start]) rare.push_back({&flight, use});
    }
    limitUses(rare);
    return rare;
}

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

bool crosses(const PhotonOpening& opening, const PhotonFlight& flight)
{
    return glm::dot(opening.centre - flight.from, opening.axis) > 0.0f &&
           crosses(opening.centre, opening.radius, flight);
}

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

/// Covers flights by spheres around cells of a grid, each of which takes most of what is left.
/// Returns the share of the use that they hold.
double coverFlights(const Grid& grid, const std::vector<UsefulFlight>& flights,
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
    double all = 0.0;
    for (uint32_t k = 0; k < flights.size(); ++k)
    {
        all += flights[k].use;
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
        if (cells[k].second.all >= kLeastUse * most) major.push_back(k);
    std::vector<bool> held(flights.size());
    double sum = 0.0;
    while (!major.empty() && openings.size() < kMostOpenings && sum < kWantedHeld * all)
    {
        const auto place = std::max_element(major.begin(), major.end(),
                                            [&](uint32_t a, uint32_t b)
                                            { return cells[a].second.use < cells[b].second.use; });
        const auto best = cells.begin() + *place;
        if (!(best->second.use > 1e-4 * all)) break;
        PhotonOpening opening;
        opening.centre = grid.centreOf(best->first);
        opening.radius = kOpeningRadius / grid.scale;
        opening.axis = axisAround(opening.centre, kAxisRadius * opening.radius, flights);
        const float length = glm::length(opening.axis);
        best->second.use = 0.0;
        if (!(length > 0.0f))
        {
            major.erase(place);
            continue;
        }
        opening.axis /= length;
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

struct OpeningFlux
{
    double towards = 0.0; ///< what surfaces send towards openings, as PhotonOpenings::look tells it
    double through = 0.0; ///< share of the flights that crosses openings
};

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

} // namespace

double seenShare(const Sphere& scene, const std::vector<PhotonFlight>& flights,
                 const std::vector<SeenPoint>& seen)
{
    const Grid surfaces(scene, kSurfaceCells);
    std::vector<bool> isSeen(std::size_t(8) * kSurfaceCells * kSurfaceCells * kSurfaceCells);
    for (const SeenPoint& point : seen)
        isSeen[surfaceCell(surfaces, point.position, point.normal)] = true;
    double count = 0.0, found = 0.0;
    for (const PhotonFlight& flight : flights)
    {
        if (!flight.stored) continue;
        count += 1.0;
        found += isSeen[surfaceCell(surfaces, flight.to, flight.normal)];
    }
    return count > 0.0 ? found / count : 1.0;
}

std::shared_ptr<const PhotonOpenings> findOpenings(const Sphere& scene,
                                                   const std::vector<PhotonFlight>& flights,
                                                   const std::vector<SeenPoint>& seen,
                                                   double photons)
{
    const std::vector<UsefulFlight> rare = rareFlights(scene, flights, seen);
    if (rare.size() < kLeastFlights) return nullptr;
    std::vector<PhotonOpening> openings;
    double held = 0.0;
    for (const uint32_t cells : kOpeningCells)
    {
        openings.clear();
        held = coverFlights(Grid(scene, cells), rare, openings);
        if (held >= kLeastHeld) break;
    }
    if (held < kLeastHeld) return nullptr;
    const OpeningFlux flux = fluxOf(openings, flights);
    if (!(flux.towards > 0.0) || flux.through > kMostThrough) return nullptr;
    return std::make_shared<const PhotonOpenings>(
        std::move(openings), static_cast<float>(kChildren * photons / flux.towards));
}

} // namespace osgRayTrace::engine
