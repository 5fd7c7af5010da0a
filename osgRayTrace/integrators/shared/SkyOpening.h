// SkyOpening.h - the rectangle that most flights to the sky cross. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/SkyFlights.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A plane with axes.
struct PlaneFrame
{
    Vec3 at, axisU, axisV, normal;
};

/// A rectangle on such a plane, along its axes.
struct PlaneBounds
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
Vec2 crossingOf(const PlaneFrame& frame, const Flight& flight);

/// A rectangle that flights cross.
struct SkyOpening
{
    PlaneFrame frame;
    PlaneBounds bounds;
    int count = 0;
    double worth = 0.0; ///< how crowded the flights are in it
};

/// Returns axes across which the scene has surfaces, those of most pixels first.
std::vector<Vec3> normalsOf(const Seen& seen);

/// Returns the width of the cells in which flights vote [engine units].
float cellWidth(const Seen& seen);

/// Returns the rectangle in which the flights are most crowded, near the cell that most blocks of
/// points send flights through; of no worth: there is none. normals: of the planes that are tried.
SkyOpening openingOf(const Seen& seen, const std::vector<Flight>& flights,
                     const std::vector<Vec3>& normals);

} // namespace osgRayTrace::engine
