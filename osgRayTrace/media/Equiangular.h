// Equiangular.h - points along a ray, evenly spread by the angle at which a light sees them.
// Layer: media.
// SPDX-License-Identifier: MIT
//
// The density of points is proportional to 1 / r^2, r the distance from the light, so that the
// falloff of a light drops out of the estimate of single scattering [Kulla12, eq. 5 and 6].
#pragma once

#include "osgRayTrace/sampling/SphericalRectangle.h"

namespace osgRayTrace::engine
{

struct EquiangularSample
{
    float t = 0.0f;   ///< along the ray
    float pdf = 0.0f; ///< [1/length]; 0: there is no sample
};

/// The stretch [begin, end] of a ray of unit direction, seen from a point. The code has no calls,
/// so that loops over lanes vectorize.
class Equiangular
{
public:
    /// leastHeight: the point counts as no nearer to the ray than this.
    OSGRAYTRACE_INLINE Equiangular(PlainVec3 origin, PlainVec3 direction, float begin, float end,
                                   PlainVec3 from, float leastHeight = 0.0f)
        : _begin(begin), _end(end)
    {
        const PlainVec3 d = from - origin;
        _foot = dot(d, direction);
        // A light on the ray itself would be seen under no angle at all.
        const float brief = 1e-4f * (end - begin);
        const float least = select(leastHeight > brief, leastHeight, brief);
        const PlainVec3 beside = d - direction * _foot;
        const float height = std::sqrt(dot(beside, beside));
        _height = select(height > least, height, least);
        // Angles are those between the ray and the ways from the light, towards the end that is
        // farther from the foot: small ones keep their digits.
        _side = select(begin - _foot < _foot - end, -1.0f, 1.0f);
        _first = upperAngle(_height, _side * (begin - _foot));
        _last = upperAngle(_height, _side * (end - _foot));
    }

    /// Returns a point of the stretch; u in [0,1).
    OSGRAYTRACE_INLINE EquiangularSample sample(float u) const
    {
        const float angle = _first + (_last - _first) * u;
        float sine, cosine;
        // Lanes without a stretch have no numbers, which cannot become a quadrant.
        sinCosTurn(select(angle > 0.0f, angle, 0.0f) * (0.5f * kInvPi), sine, cosine);
        const float along = _height * cosine / select(sine > 1e-30f, sine, 1e-30f);
        const float t = _foot + _side * along;
        const float above = select(t > _begin, t, _begin);
        const float inside = select(above < _end, above, _end);
        return {inside, pdf(inside)};
    }

    /// Returns the density of points at t [1/length].
    OSGRAYTRACE_INLINE float pdf(float t) const
    {
        const float angle = std::fabs(_last - _first);
        const float along = t - _foot;
        const float density = _height / (angle * (_height * _height + along * along));
        return select(angle > 0.0f, density, 0.0f);
    }

private:
    float _begin, _end, _foot, _height;
    float _side; ///< 1 or -1: the end of the stretch that is farther from the foot
    float _first, _last;
};

} // namespace osgRayTrace::engine
