// FlightMeans.h - what random flights along one ray through volumes have in the mean.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/sampling/Hash.h"

#include "tests/Statistics.h"

#include <array>

namespace osgRayTrace::engine::test
{

/// Estimates by channel, all of them of the transmittance T of the whole ray or of 1 - T.
struct FlightMeans
{
    std::array<Estimate, 3> left;     ///< T, by flights without a collision
    std::array<Estimate, 3> collided; ///< 1 - T, by the collisions of media that only scatter
    std::array<Estimate, 3> ways;     ///< T, by ways
    std::array<Estimate, 3> shadows;  ///< T, by residual ratio tracking
};

/// Returns the means of 40,000 flights from the ray's begin to its end.
inline FlightMeans flightMeans(const GridRay& ray, float end)
{
    FlightMeans means;
    for (uint32_t k = 0; k < 40000; ++k)
    {
        NumberStream numbers(hash(k, 3u));
        const GridFlight flight = ray.flight(Vec3(0.5f, 0.3f, 0.2f), numbers);
        const GridWay way = ray.way(numbers);
        const Vec3 shadow = ray.transmittance(0.0f, end, numbers);
        const Scatterers here = flight.collides ? ray.scatterersAt(flight.distance) : Scatterers();
        Vec3 sum(0.0f);
        for (int i = 0; i < here.count; ++i)
            sum += here.sigmaS[std::size_t(i)];
        for (std::size_t c = 0; c < 3; ++c)
        {
            means.left[c].add(flight.collides ? 0.0 : double(flight.weight[int(c)]));
            means.collided[c].add(double(flight.weight[int(c)] * sum[int(c)]));
            means.ways[c].add(double(way.left[int(c)]));
            means.shadows[c].add(double(shadow[int(c)]));
        }
    }
    return means;
}

} // namespace osgRayTrace::engine::test
