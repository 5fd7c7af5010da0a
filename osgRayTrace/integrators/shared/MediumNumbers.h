// MediumNumbers.h - the random numbers of a stretch of a path within a medium. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/sampling/Sampler.h"

namespace osgRayTrace::engine
{

/// Names the use of each two-dimensional point of a stretch.
enum MediumDimension : uint32_t
{
    MediumFlight = 0,             ///< x: free flight, y: Russian roulette
    MediumPhase = 1,              ///< direction after the collision
    MediumBoundary = 2,           ///< direction at a smooth boundary
    MediumChoice = 3,             ///< x: which light, y: which point on the ray
    MediumLightPoint = 4,         ///< point on the light
    MediumSkyPoint = 5,           ///< x: which point on the ray, y: which stratum of the sky
    MediumSky = 6,                ///< direction of the sky
    MediumGrid = 0x40000000,      ///< a seed: free flights through volumes
    MediumGridWay = 0x40000001,   ///< a seed: transmittance of volumes up to a point
    MediumGridBeams = 0x80000000, ///< a seed: that up to beams; 0x80000000 + k behind k volumes
    MediumDelta = 7,              ///< x: which point on the ray; 7 + 2 k of light k
    MediumDeltaPoint = 8,         ///< point on the light; 8 + 2 k of light k
};

/// The numbers of one stretch. The first stretch of each ray takes points of Sobol's sequence over
/// the passes; the walk that may follow is too long for a sequence and takes independent numbers.
class MediumNumbers
{
public:
    MediumNumbers() = default;
    /// number: of the path's ray; step: of the stretch along this ray and its collisions.
    MediumNumbers(uint32_t pathSeed, uint32_t pass, int number, int step)
        : _seed(pathSeed),
          _pass(pass),
          _first(hash(kMedium + static_cast<uint32_t>(number), static_cast<uint32_t>(step))),
          _sequence(maskOf(step == 0))
    {
    }

    Vec2 at(uint32_t dimension) const
    {
        Vec2 point;
        if (_sequence)
            sobol2(_pass, dimensionSeed(_seed, _first + dimension), point.x, point.y);
        else
            setIndependent(dimension, point.x, point.y);
        return point;
    }

    /// Does the same without branches, for loops over lanes.
    OSGRAYTRACE_INLINE void set(uint32_t dimension, float& x, float& y) const
    {
        float sequenceX, sequenceY;
        sobol2(_pass, dimensionSeed(_seed, _first + dimension), sequenceX, sequenceY);
        setIndependent(dimension, x, y);
        x = select(_sequence, sequenceX, x);
        y = select(_sequence, sequenceY, y);
    }

    /// Returns a seed for numbers of any count.
    uint32_t seedOf(uint32_t dimension) const
    {
        return hash(dimensionSeed(_seed, _first + dimension), _pass);
    }

private:
    OSGRAYTRACE_INLINE void setIndependent(uint32_t dimension, float& x, float& y) const
    {
        const uint32_t key = hash(dimensionSeed(_seed, _first + dimension), _pass);
        x = unitFloat(key);
        y = unitFloat(hash(key + 0x9e3779b9u));
    }

    static constexpr uint32_t kMedium = 0x6d656469u; ///< tells these dimensions from all others
    uint32_t _seed = 0, _pass = 0, _first = 0;
    uint32_t _sequence = ~0u; ///< all bits or none
};

/// Sets the points of a dimension of sixteen stretches.
void setNumbers(const MediumNumbers* numbers, uint32_t dimension, FloatLanes& x, FloatLanes& y);

} // namespace osgRayTrace::engine
