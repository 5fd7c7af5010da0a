// OpeningCover.h - covers the flights of photons by spheres where they come together. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonOpenings.h"
#include "osgRayTrace/photons/PhotonTargets.h"
#include "osgRayTrace/photons/TracedPhotons.h"

#include <vector>

namespace osgRayTrace::engine
{

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
    /// Returns the number of a cell and of an octant of normals.
    uint32_t surfaceOf(Vec3 p, Vec3 n) const
    {
        return cellOf(p) * 8 + ((n.x < 0.0f) | (n.y < 0.0f) << 1 | (n.z < 0.0f) << 2);
    }
    std::size_t surfaces() const { return std::size_t(8) * count * count * count; }
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

struct UsefulFlight
{
    const PhotonFlight* flight;
    double use;
};

struct OpeningFlux
{
    double towards = 0.0; ///< what surfaces send towards openings, as PhotonOpenings::look tells it
    double through = 0.0; ///< share of the flights that crosses openings
};

OpeningFlux fluxOf(const std::vector<PhotonOpening>& openings,
                   const std::vector<PhotonFlight>& flights);

/// Returns whether a flight crosses the sphere of an opening, along its axis.
bool crosses(const PhotonOpening& opening, const PhotonFlight& flight);

/// How spheres are put around cells of a grid.
struct CoverRules
{
    std::size_t mostOpenings; ///< all grids together
    double leastUse;   ///< of what the best cell of a grid holds, the share that any must hold
    double wantedHeld; ///< share of the use of all flights with which there are enough
    float radius;      ///< of a sphere, over the side of its cell
};

/// Covers those flights that no opening holds yet by spheres around cells of a grid, each of which
/// takes most of what is left, and marks them as held. Spheres are put in the middle of the flights
/// of their cells, and their axes are turned until all flights go along them, also those that graze
/// the wall around an opening. Returns the share of the use of all flights
/// that openings hold.
double coverFlights(const Grid& grid, const std::vector<UsefulFlight>& flights,
                    const CoverRules& rules, std::vector<bool>& held,
                    std::vector<PhotonOpening>& openings);

} // namespace osgRayTrace::engine
