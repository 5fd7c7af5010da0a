// SkyFlights.h - rays from what a view sees that meet the sky. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/ShadowLanes.h"

#include <vector>

namespace osgRayTrace::engine
{

constexpr int kFlightBlocks = 64; ///< blocks of sixteen surfaces that send rays
constexpr int kFlightRounds = 16; ///< rays of a point
constexpr uint32_t kFlightSeed = 0x5c9b1e77u;

/// A ray that has met the sky.
struct Flight
{
    Vec3 from, direction;
    int block, lane; ///< of the point
};

/// Sixteen points.
struct SeenBlock
{
    SurfaceLanes surface;
    Vec3Lanes normal;
    LaneMask lanes = 0;
    int sent[kLanes] = {}; ///< rays that sendAround() has sent from each of the points
};

struct Seen
{
    std::vector<SeenBlock> blocks;
    Vec3 low{kInfinity}, high{-kInfinity}; ///< bounds of the points and the eye
};

/// Traces the middles of pixels in blocks that are spread over the image, and rays on from there:
/// what lies around is seen in close-ups, too.
Seen lookAround(const PassContext& context, TileCounts& counts);

/// Sets the ray from a point of a block, unless it leaves to the other side of the surface.
void setFlight(const SeenBlock& seen, int i, Vec3 wi, LightLanes& samples);

/// Traces the rays that are set and adds those that meet the sky to the flights.
void addFlights(const PassContext& context, const SeenBlock& seen, int block, LightLanes& samples,
                TileCounts& counts, std::vector<Flight>& flights);

/// Sends rays of some rounds from all that is seen, as Lambert's surfaces do.
void sendAround(const PassContext& context, Seen& seen, int first, int last, TileCounts& counts,
                std::vector<Flight>& flights);

/// Sets the bounds to those of the points in the blocks' lanes, and the eye.
void setBounds(Vec3 eye, Seen& seen);

} // namespace osgRayTrace::engine
