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

/// Cells along a side of the cube around the scene: of places that are looked at, of the surfaces
/// for which the use of photons is summed up, and of openings, the finest first: those of the first
/// search, of which one size is taken, and the smaller ones, each for what finer ones leave.
constexpr uint32_t kSeenCells = 32, kUseCells = 16;
constexpr uint32_t kFirstCells[] = {64, 32}, kFineCells[] = {256, 128, 64};

constexpr CoverRules kFirstRules{64, 0.25, 0.998, 1.0f};
constexpr CoverRules kFineRules{64, 0.02, 0.999, 1.3f};

/// Openings hold at least this share of the use of the flights that enter.
constexpr double kFirstHeld = 0.75, kFineHeld = 0.9;

/// The expected number of children of a photon, all its surfaces together, if nothing limits it.
constexpr double kFirstChildren = 1.0, kFineChildren = 4.0;

/// Flights from which openings are found: at least, and at most for the small ones, as the time and
/// the memory of the search go with their number.
constexpr std::size_t kLeastFlights = 16, kMostFlights = 16384;

/// Openings are small if no more than these shares of all flights go through them, and of the power
/// of all flights is that of those that enter.
constexpr double kMostThrough = 0.035, kMostEntering = 0.005;

/// A flight enters if its end is so many times as useful as its start.
constexpr double kEntry = 8.0;

/// Of the mean use of the ends of entering flights, the share that any must have. The rest ends in
/// cells that hold surfaces on both sides of a wall.
constexpr double kLeastUse = 0.2;

/// Of the weight of the best opening, the share that any must have.
constexpr float kLeastWeight = 0.05f;

/// What photons at surfaces are good for: theirs and that of their later flights, by cell.
class SurfaceUses
{
public:
    SurfaceUses(const Sphere& scene, const std::vector<PhotonFlight>& flights,
                const std::vector<SeenPoint>& seen)
        : _grid(scene, kUseCells), _uses(_grid.surfaces()), _powers(_grid.surfaces())
    {
        const Grid places(scene, kSeenCells);
        std::vector<float> looks(places.surfaces()), hits(places.surfaces());
        for (const SeenPoint& point : seen)
            ++looks[places.surfaceOf(point.position, point.normal)];
        const double unit = meanPower(flights);
        for (const PhotonFlight& flight : flights)
            if (flight.stored)
                hits[places.surfaceOf(flight.to, flight.normal)] +=
                    flight.power / static_cast<float>(unit);
        // A further photon takes the more off the relative error of a place, the fewer there are.
        std::vector<double> uses(flights.size()); // of a flight and of all that follow
        for (std::size_t k = flights.size(); k-- > 0;)
        {
            const PhotonFlight& flight = flights[k];
            const auto power = static_cast<double>(flight.power);
            if (flight.stored)
            {
                const uint32_t place = places.surfaceOf(flight.to, flight.normal);
                const double dense = static_cast<double>(hits[place]) + 4.0;
                uses[k] += power * static_cast<double>(looks[place]) / (dense * dense);
            }
            if (flight.before != kInvalid) uses[flight.before] += uses[k];
            const uint32_t cell = _grid.surfaceOf(flight.to, flight.normal);
            _uses[cell] += uses[k];
            _powers[cell] += power;
            _allUses += uses[k];
            _allPowers += power;
        }
    }

    /// Returns the use of a photon at the end of a flight, over its power.
    double at(const PhotonFlight& flight) const
    {
        const uint32_t cell = _grid.surfaceOf(flight.to, flight.normal);
        return _uses[cell] / _powers[cell];
    }
    double mean() const { return _allUses / _allPowers; }

private:
    /// Returns the mean power of photons as they leave lights.
    static double meanPower(const std::vector<PhotonFlight>& flights)
    {
        double sum = 0.0, count = 0.0;
        for (const PhotonFlight& flight : flights)
        {
            if (flight.before != kInvalid) continue;
            sum += static_cast<double>(flight.power);
            count += 1.0;
        }
        return sum > 0.0 ? sum / count : 1.0;
    }

    Grid _grid;
    std::vector<double> _uses, _powers; ///< by cell
    double _allUses = 0.0, _allPowers = 0.0;
};

/// Returns the flights from where photons are of little use to where they are of much.
std::vector<UsefulFlight> enteringFlights(const Sphere& scene,
                                          const std::vector<PhotonFlight>& flights,
                                          const std::vector<SeenPoint>& seen)
{
    const SurfaceUses uses(scene, flights, seen);
    std::vector<UsefulFlight> entering;
    double sum = 0.0, squares = 0.0;
    for (const PhotonFlight& flight : flights)
    {
        const double use = uses.at(flight), power = static_cast<double>(flight.power);
        const double before =
            flight.before == kInvalid ? uses.mean() : uses.at(flights[flight.before]);
        if (!(use > kEntry * before && before < kEntry * uses.mean())) continue;
        entering.push_back({&flight, power * use});
        sum += power * use;
        squares += power * use * use;
    }
    const double least = kLeastUse * squares / sum;
    const auto isPoor = [&](const UsefulFlight& useful)
    { return !(useful.use > least * static_cast<double>(useful.flight->power)); };
    entering.erase(std::remove_if(entering.begin(), entering.end(), isPoor), entering.end());
    return entering;
}

/// Returns kMostFlights of the flights, or all if there are no more.
std::vector<UsefulFlight> someOf(std::vector<UsefulFlight> flights)
{
    if (flights.size() <= kMostFlights) return flights;
    std::vector<UsefulFlight> some;
    for (std::size_t k = 0; k < kMostFlights; ++k)
        some.push_back(flights[k * flights.size() / kMostFlights]);
    return some;
}

/// Sets the weights of openings and drops those that bring little. Of a sphere's cone one does not
/// know which part sees through; the least variance for so many children is then had by densities
/// in proportion to the root of the share that gets through.
void weighOpenings(const std::vector<UsefulFlight>& entering,
                   const std::vector<PhotonFlight>& flights, std::vector<PhotonOpening>& openings)
{
    std::vector<double> through(openings.size());
    for (const UsefulFlight& useful : entering)
        for (std::size_t k = 0; k < openings.size(); ++k)
            if (crosses(openings[k], *useful.flight))
            {
                through[k] += static_cast<double>(useful.flight->power);
                break;
            }
    float best = 0.0f;
    for (std::size_t k = 0; k < openings.size(); ++k)
    {
        const double towards = fluxOf({openings[k]}, flights).towards;
        openings[k].weight =
            towards > 0.0 ? static_cast<float>(std::sqrt(through[k] / towards)) : 0.0f;
        best = std::max(best, openings[k].weight);
    }
    const auto isPoor = [&](const PhotonOpening& opening)
    { return !(opening.weight > kLeastWeight * best); };
    openings.erase(std::remove_if(openings.begin(), openings.end(), isPoor), openings.end());
    for (PhotonOpening& opening : openings)
        opening.weight /= best;
}

/// Returns the share of the power of all flights that entering ones have.
double enteringShare(const std::vector<UsefulFlight>& entering,
                     const std::vector<PhotonFlight>& flights)
{
    double sum = 0.0, all = 0.0;
    for (const UsefulFlight& useful : entering)
        sum += static_cast<double>(useful.flight->power);
    for (const PhotonFlight& flight : flights)
        all += static_cast<double>(flight.power);
    return sum / all;
}

} // namespace

double seenShare(const Sphere& scene, const std::vector<PhotonFlight>& flights,
                 const std::vector<SeenPoint>& seen)
{
    const Grid surfaces(scene, kSeenCells);
    std::vector<bool> isSeen(surfaces.surfaces());
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
    const std::vector<UsefulFlight> entering = enteringFlights(scene, flights, seen);
    if (entering.size() < kLeastFlights || enteringShare(entering, flights) > kMostEntering)
        return nullptr;
    std::vector<PhotonOpening> openings;
    double held = 0.0;
    for (const uint32_t cells : kFirstCells)
    {
        openings.clear();
        std::vector<bool> isHeld(entering.size());
        held = coverFlights(Grid(scene, cells), entering, kFirstRules, isHeld, openings);
        if (held >= kFirstHeld) break;
    }
    if (held < kFirstHeld) return nullptr;
    const OpeningFlux flux = fluxOf(openings, flights);
    if (!(flux.towards > 0.0) || flux.through > kMostThrough) return nullptr;
    return std::make_shared<const PhotonOpenings>(
        std::move(openings), static_cast<float>(kFirstChildren * photons / flux.towards));
}

std::shared_ptr<const PhotonOpenings>
refineOpenings(const Sphere& scene, const std::vector<PhotonFlight>& flights,
               const std::vector<SeenPoint>& seen, double photons,
               const std::shared_ptr<const PhotonOpenings>& first)
{
    const std::vector<UsefulFlight> entering = someOf(enteringFlights(scene, flights, seen));
    if (entering.size() < kLeastFlights) return first;
    std::vector<PhotonOpening> openings;
    std::vector<bool> isHeld(entering.size());
    double held = 0.0;
    for (const uint32_t cells : kFineCells)
        held = coverFlights(Grid(scene, cells), entering, kFineRules, isHeld, openings);
    if (held < kFineHeld) return first;
    weighOpenings(entering, flights, openings);
    const OpeningFlux flux = fluxOf(openings, flights);
    if (!(flux.towards > 0.0)) return first;
    return std::make_shared<const PhotonOpenings>(
        std::move(openings), static_cast<float>(kFineChildren * photons / flux.towards));
}

} // namespace osgRayTrace::engine
