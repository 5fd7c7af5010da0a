// OpeningFinder.cpp - finds small openings that light comes through to what views see. Layer:
// photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/OpeningFinder.h"

#include "osgRayTrace/photons/OpeningCover.h"

#include <algorithm>
#include <cmath>

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

/// Flights from which openings are found, at least.
constexpr std::size_t kLeastFlights = 16;

/// The expected number of children of a photon, all its surfaces together, if nothing limits it.
constexpr double kChildren = 1.0;

/// Openings are small if no more than this share of all flights goes through them.
constexpr double kMostThrough = 0.035;

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
        ++looks[surfaces.surfaceOf(point.position, point.normal)];
    for (const PhotonFlight& flight : flights)
        if (flight.stored) ++hits[surfaces.surfaceOf(flight.to, flight.normal)];
    const auto useOf = [&](const PhotonFlight& flight)
    {
        if (!flight.stored) return 0.0;
        const uint32_t cell = surfaces.surfaceOf(flight.to, flight.normal);
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

} // namespace

double seenShare(const Sphere& scene, const std::vector<PhotonFlight>& flights,
                 const std::vector<SeenPoint>& seen)
{
    const Grid surfaces(scene, kSurfaceCells);
    std::vector<bool> isSeen(std::size_t(8) * kSurfaceCells * kSurfaceCells * kSurfaceCells);
    for (const SeenPoint& point : seen)
        isSeen[surfaces.surfaceOf(point.position, point.normal)] = true;
    double count = 0.0, found = 0.0;
    for (const PhotonFlight& flight : flights)
    {
        if (!flight.stored) continue;
        count += 1.0;
        found += isSeen[surfaces.surfaceOf(flight.to, flight.normal)];
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
        std::vector<bool> isHeld(rare.size());
        held = coverFlights(Grid(scene, cells), rare,
                            {kMostOpenings, kLeastUse, kWantedHeld, kOpeningRadius, false}, isHeld,
                            openings);
        if (held >= kLeastHeld) break;
    }
    if (held < kLeastHeld) return nullptr;
    const OpeningFlux flux = fluxOf(openings, flights);
    if (!(flux.towards > 0.0) || flux.through > kMostThrough) return nullptr;
    return std::make_shared<const PhotonOpenings>(
        std::move(openings), static_cast<float>(kChildren * photons / flux.towards));
}

} // namespace osgRayTrace::engine
