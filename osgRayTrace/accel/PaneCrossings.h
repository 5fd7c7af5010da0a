// PaneCrossings.h - where shadow rays pass panes. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/RayBlock.h"

namespace osgRayTrace::engine
{

/// Two panes of two sides each are the most that a ray through a window usually meets.
constexpr int kMostCrossings = 4;

/// A place where a ray meets a pane, in Embree's numbers.
struct PaneCrossing
{
    float t, u, v;
    uint32_t primitive, geometry, instance;
};

/// The places where the rays of a block pass panes, in no order.
class PaneCrossings
{
public:
    /// Keeps the crossing of a lane. Returns false if there is no place left: the lane is then one
    /// of full(). Embree may ask twice for one triangle, and rays through a common edge of two meet
    /// both: such a crossing is kept once.
    bool note(uint32_t lane, const PaneCrossing& crossing)
    {
        if (lane >= static_cast<uint32_t>(kLanes)) return true; // a copy that fills up a packet
        int k = 0;
        for (; k < kMostCrossings && ((_beyond[k] >> lane) & 1u); ++k)
            if (isSame(_rounds[k], lane, crossing)) return true;
        if (k == kMostCrossings)
        {
            _full |= 1u << lane;
            return false;
        }
        Round& round = _rounds[k];
        round.t[lane] = crossing.t;
        round.u[lane] = crossing.u;
        round.v[lane] = crossing.v;
        round.primitive[lane] = crossing.primitive;
        round.geometry[lane] = crossing.geometry;
        round.instance[lane] = crossing.instance;
        _beyond[k] |= 1u << lane;
        return true;
    }

    /// Returns the lanes that meet more panes than have a place here.
    LaneMask full() const { return _full; }

    /// Returns the lanes that have passed more than k panes.
    LaneMask beyond(int k) const { return _beyond[k]; }

    /// Returns the rays with the hits of crossing k of each lane of beyond(k), none in other lanes.
    void hits(int k, const RayBlock& rays, RayHitBlock& hits) const
    {
        const Round& round = _rounds[k];
        hits.ray = rays;
        hits.ray.tFar = round.t;
        hits.u = round.u;
        hits.v = round.v;
        hits.primitive = round.primitive;
        hits.instance = round.instance;
        for (int i = 0; i < kLanes; ++i)
            hits.geometry[i] = round.geometry[i] | ~laneBit(_beyond[k], i);
    }

private:
    struct Round
    {
        FloatLanes t, u, v;
        UintLanes primitive, geometry, instance;
    };

    static bool isSame(const Round& round, uint32_t lane, const PaneCrossing& crossing)
    {
        return round.t[lane] == crossing.t || (round.primitive[lane] == crossing.primitive &&
                                               round.geometry[lane] == crossing.geometry &&
                                               round.instance[lane] == crossing.instance);
    }

    LaneMask _beyond[kMostCrossings] = {};
    LaneMask _full = 0;
    Round _rounds[kMostCrossings];
};

} // namespace osgRayTrace::engine
