// Equiangular.h - points along a ray, evenly spread by the angle at which a light sees them.
// Layer: media.
// SPDX-License-Identifier: MIT
//
// The density of points is proportional to 1 / r^2, r the distance from the light, so that the
// falloff of a light drops out of the estimate of single scattering [Kulla12, eq. 5 and 6].
#pragma once

#include "osgRayTrace/base/Math.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

struct EquiangularSample
{
    float t = 0.0f;   ///< along the ray
    float pdf = 0.0f; ///< [1/length]; 0: there is no sample
};

/// The stretch [begin, end] of a ray of unit direction, seen from a point.
class Equiangular
{
public:
    /// leastHeight: the point counts as no nearer to the ray than this.
    Equiangular(Vec3 origin, Vec3 direction, float begin, float end, Vec3 from,
                float leastHeight = 0.0f)
        : _begin(begin), _end(end)
    {
        const Vec3 d = from - origin;
        _foot = glm::dot(d, direction);
        // A light on the ray itself would be seen under no angle at all.
        const float least = std::max(leastHeight, 1e-4f * (end - begin));
        _height = std::max(glm::length(d - direction * _foot), least);
        _low = std::atan2(begin - _foot, _height);
        _high = std::atan2(end - _foot, _height);
    }

    /// Returns a point of the stretch; u in [0,1).
    EquiangularSample sample(float u) const
    {
        const float t = _foot + _height * std::tan(_low + (_high - _low) * u);
        const float inside = std::clamp(t, _begin, _end);
        return {inside, pdf(inside)};
    }

    /// Returns the density of points at t [1/length].
    float pdf(float t) const
    {
        const float angle = _high - _low;
        if (!(angle > 0.0f)) return 0.0f;
        const float along = t - _foot;
        return _height / (angle * (_height * _height + along * along));
    }

private:
    float _begin, _end, _foot, _height, _low, _high;
};

} // namespace osgRayTrace::engine
