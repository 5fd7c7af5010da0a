// MediumWay.h - a stretch of a ray in lengths of a medium's full density. Layer: media.
// SPDX-License-Identifier: MIT
//
// A medium that thins out with height has the density rho(x) = exp(-max(0, x)), x the height over
// its base in scale heights; all of its coefficients are proportional to rho. Along a ray x rises
// by k per length, so that the density's integral over a stretch of length l above the base is
//
//   integral of rho = rho_low (1 - exp(-|k| l)) / |k|,  rho_low the density at the lower end
//
// and below the base it is l. In these lengths the medium is a homogeneous one: optical depths are
// sigmaT times them, and free flights are sampled in them and taken back to the ray by the inverse
// in closed form. In densities of places, rho drops out of sigmaS / pdf. The medium is that of
// [Bitterli14] with an even part below; the inverse is our own.
#pragma once

#include "osgRayTrace/media/MediumTable.h"

#include <algorithm>
#include <utility>

namespace osgRayTrace::engine
{

/// The part of a ray within a medium, which is measured. Of an even medium all lengths are those of
/// the ray.
class MediumWay
{
public:
    MediumWay() = default;
    /// The ray has a unit direction; the part is finite.
    MediumWay(const MediumRecord& medium, Vec3 origin, Vec3 direction, RayPart part)
        : _begin(part.begin), _length(std::max(0.0f, part.end - part.begin))
    {
        if (medium.thins) setHeights(medium, origin, direction);
    }

    /// Returns the length of the whole part at full density.
    float length() const { return _thins ? lengthOf(_length) : _length; }

    /// Returns the length at full density from the part's begin to a distance along the ray.
    float lengthTo(float distance) const
    {
        const float way = distance - _begin;
        return _thins ? lengthOf(std::clamp(way, 0.0f, _length)) : way;
    }

    /// Returns the distance along the ray of a length at full density, from 0 to length().
    float distanceAt(float length) const
    {
        return _begin + (_thins ? std::clamp(wayOf(length), 0.0f, _length) : length);
    }

    /// Returns the density at a distance along the ray, 1 at most.
    float density(float distance) const { return _thins ? densityOf(distance - _begin) : 1.0f; }

    /// Returns the least and the largest density between two distances along the ray.
    std::pair<float, float> densities(float begin, float end) const
    {
        const float a = density(begin), b = density(end);
        return {std::min(a, b), std::max(a, b)};
    }

    /// Returns a distance along the ray, behind the given one, up to which the density changes by a
    /// factor of e^2 at most, or is below e^-30; infinity: there is none before the ray's end.
    float evenEnd(float distance) const;

private:
    void setHeights(const MediumRecord& medium, Vec3 origin, Vec3 direction);
    float lengthAbove(float begin, float end) const;
    float lengthOf(float way) const;
    float wayOf(float length) const;
    float wayFromLowEnd(float share, float length, float before) const;
    float densityOf(float way) const;

    float _begin = 0.0f, _length = 0.0f;
    bool _thins = false;
    float _height = 0.0f; ///< at the part's begin, over the base [scale heights]
    float _rise = 0.0f;   ///< [scale heights/length]
    float _fold = 0.0f;   ///< where the ray comes through the base, from the part's begin
};

} // namespace osgRayTrace::engine
